#pragma once

#include <Eigen/Core>
#include <limits>

#include "vacuum_gripper_sim/core/rigid_surface.h"
#include "vacuum_gripper_sim/core/triangle_mesh.h"

namespace vacuum_gripper_sim {

/** What one point remembers of one surface from query to query. One for every pair of node and
 surface; a new one has seen nothing.

 It is the faster the less the point moved relative to the surface. Asked again at the same place it
 only repeats itself; where the last distance d less the way w since then is at least `reach`, the
 answer is the lower bound d - w with the last normal; else the search starts at the triangle seen
 last. Nothing else depends on the past, except for the sides of sheets.

 **Open meshes** are sheets with two sides (see TriangleMesh). Their distance is signed by the side
 that the point belongs to:

 - It is the side on which BeginStep() first found the point, wherever the steps begin from then on:
   pressed through the sheet by less than 5 mm it sees a negative distance and the normal of its
   side, so that contact pushes it back. Within a step the side never changes, and the gap
   d(x0) + n(x0) . (x1 - x0) holds a node that starts above the sheet above it.
 - Past a border of the sheet the distance is that to the border, positive, and its direction that
   from the border. A point that goes round the border by more than .1 mm changes sides; one that is
   less below than that, as solvers leave it, is taken to be level with the sheet.
 - A point that BeginStep() finds farther away than `reach`, or at a sheet that is no part of the
 one before, belongs to the side where it is then.

 Without BeginStep(), as in Distance(), a point belongs to the front: the side from which the
 triangles are counter-clockwise. */
class SurfaceSighting {
 public:
  /// Of a point that is really there, at the start of a step. @param p_S In the shape's frame. [m]
  SurfaceDistance BeginStep(const Shape& shape, const Eigen::Vector3d& p_S, double reach = kExact);

  /// Of a point that may be a trial. @returns distance and normal in the shape's frame.
  SurfaceDistance Look(const Shape& shape, const Eigen::Vector3d& p_S, double reach = kExact);

  /// The same in the frame F of a placed surface. @param p_F The point. [m]
  SurfaceDistance BeginStep(const RigidSurface& surface, const Eigen::Vector3d& p_F, double reach);
  SurfaceDistance Look(const RigidSurface& surface, const Eigen::Vector3d& p_F);

  static constexpr double kExact = std::numeric_limits<double>::infinity();

 private:
  SurfaceDistance LookAtMesh(const TriangleMesh& mesh, const Eigen::Vector3d& p_S, double reach);
  bool Settle(const TriangleMesh& mesh);

  bool has_seen_{false};
  Eigen::Vector3d p_S_;   // where the point was seen
  MeshPoint point_;       // and what it saw, by the winding
  SurfaceDistance seen_;  // the same from its side
  int side_{0};           // 1: front, -1: back, 0: not known
  int shell_{0};          // of which it is the side
};

}  // namespace vacuum_gripper_sim
