#pragma once

namespace vacuum_gripper_sim {

/// Calls of malloc and its kin by this program so far, operator new and Eigen's among them.
long CountAllocations();

}  // namespace vacuum_gripper_sim
