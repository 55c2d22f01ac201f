#pragma once

#include <ros/node_handle.h>
#include <vacuum_gripper_sim/SetFault.h>

#include <cstddef>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/config/fault_list.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {

/// Faults on command: the service `~set_fault`, and those that are on from the start.
class FaultServer {
 public:
  /** @param faults On from the start. @param list None on.
      @throws std::invalid_argument naming the first of them that cannot be. */
  FaultServer(ros::NodeHandle private_nh, const std::vector<FaultCommand>& faults, FaultList list);

  /// Before every step: tells the simulator what has changed, its objects included.
  void Update(Simulator* simulator);
  bool sensor_stuck() const { return list_.sensor_stuck(); }

 private:
  bool OnSetFault(SetFault::Request& request, SetFault::Response& response);

  FaultList list_;
  bool changed_{true};
  std::size_t num_objects_{0};  // That the simulator had when it was told.
  ros::ServiceServer server_;
};

}  // namespace vacuum_gripper_sim
