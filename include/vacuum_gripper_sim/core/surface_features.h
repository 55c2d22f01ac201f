#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_surface.h"

namespace vacuum_gripper_sim {

/// A point of a shape's sharp edge.
struct FeaturePoint {
  Eigen::Vector3d p_S;  ///< In the shape's frame. [m]
  Eigen::Vector3d
      outward_S;  ///< Unit vector out of the solid, halfway between the faces that meet.
};

/** Points along what of a shape can poke through a soft wall between the wall's nodes: convex edges
 and corners of boxes, rims of cylinders, of meshes the edges whose faces turn by more than 30
 degrees, and open borders. Planes and spheres have none.

 Edges are sampled evenly from end to end, at most `spacing` apart; corners are there once, rims are
 closed rings. Edges of a mesh are sampled one by one: where they are shorter than half of
 `spacing`, as on a scan, a vertex is left out if a point less than that away was taken before.

 @param spacing Largest distance of neighbours along an edge. [m] > 0 */
std::vector<FeaturePoint> SharpFeatures(const Shape& shape, double spacing);

}  // namespace vacuum_gripper_sim
