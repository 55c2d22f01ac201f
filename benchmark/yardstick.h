#pragma once

namespace vacuum_gripper_sim {

/// Median thread-CPU time of Eigen's product of two dense 512 x 512 matrices: how fast this core is
/// just now, with this program's compiler flags. [s]
double Yardstick();

}  // namespace vacuum_gripper_sim
