#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_world.h"

namespace vacuum_gripper_sim {

/// Which object was put into the cup since the last step, so far and so deep that no motion of a
/// step answers it; empty if none was.
/// @param nodes Of the cup, to be looked at. @param x_W All nodes, 3 by #nodes. [m]
std::string DescribeJump(const RigidWorld& world, const std::vector<int>& nodes,
                         const Eigen::Matrix3Xd& x_W);

/// Which free object is so deep inside another one that contact would throw it out; empty if none
/// is. For objects as they are put somewhere: a fixed one may run into a free one later.
std::string DescribeOverlap(const RigidWorld& world);

}  // namespace vacuum_gripper_sim
