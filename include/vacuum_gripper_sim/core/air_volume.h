#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"

namespace vacuum_gripper_sim {

/** Air between a cup and what lies before it, in columns along the suction axis: by the divergence
 theorem the sum over the wet points of their height over the object times their projected area. A
 column ends at the first object, or on the plane across the dry points next to wet ones: the ring
 that touches first.
 @param wet By point. @param x_W Positions of all mesh nodes, 3 by #nodes. [m]
 @param area_vectors Of the points, see PointAreaVectors(). [m^2]
 @param axis_W Unit vector out of the cup. @param distance Of a point to the nearest surface; +inf
 without any. [m] @returns [m^3] */
double AirVolume(const CavitySurface& surface, int cup, const std::vector<bool>& wet,
                 const Eigen::Matrix3Xd& x_W, const Eigen::Matrix3Xd& area_vectors,
                 const Eigen::Vector3d& axis_W,
                 const std::function<double(const Eigen::Vector3d& p_W)>& distance);

/** What a step adds to that air while the cup touches the object: swept by the wet points, as they
 move with respect to the object, with the mean of their area vectors over the step. It is the work
 of a unit of pressure, so that no seal that moves can make air or energy.
 @param motion_W Of the points with respect to the object before each, 3 by #points. [m]
 @param areas_begin,areas_end Area vectors. [m^2] @returns [m^3] */
double SweptVolume(const CavitySurface& surface, int cup, const std::vector<bool>& wet,
                   const Eigen::Matrix3Xd& motion_W, const Eigen::Matrix3Xd& areas_begin,
                   const Eigen::Matrix3Xd& areas_end);

}  // namespace vacuum_gripper_sim
