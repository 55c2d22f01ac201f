#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "vacuum_gripper_sim/core/grip_state.h"
#include "vacuum_gripper_sim/core/rigid_object.h"
#include "vacuum_gripper_sim/core/step_result.h"
#include "vacuum_gripper_sim/core/vacuum_faults.h"

namespace vacuum_gripper_sim {

/// A moment of a simulation, to be taken up again by any Simulator of the same cups and parameters:
/// a value, safe to hand to another thread.
struct Snapshot {
  double time{0.0};      ///< Simulated. [s]
  Command command;       ///< That led here.
  Eigen::Matrix3Xd x_W;  ///< Positions of all nodes, 3 by #nodes. [m]
  Eigen::Matrix3Xd v_W;  ///< Velocities. [m/s]
  GripState grip;
  VacuumFaults faults;
  std::vector<RigidObject> objects;  ///< Where they are, free ones with their velocities.
};

}  // namespace vacuum_gripper_sim
