#pragma once

#include <ros/node_handle.h>

#include <string>

#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/// Publishes what one of a gripper's named cups does below `~cups/<name>/`: `wrench`, `seal_state`
/// (latched) and `pressure`, as the gripper's own topics do in sum, in the cup's own frame.
class CupPublisher {
 public:
  /// @param cup With a name. @param cup_frame Of the gripper; that of the cup is below it.
  CupPublisher(ros::NodeHandle private_nh, const CupMount& cup, const std::string& cup_frame);

  /// `<cup_frame>/<name>`.
  const std::string& frame() const { return frame_; }

  /// Wrench and pressure.
  void PublishForces(const ros::Time& stamp, const CupResult& cup, double ambient_pressure) const;
  /// What is latched.
  void PublishState(const ros::Time& stamp, const CupResult& cup, double setpoint) const;

 private:
  std::string frame_;
  ros::Publisher wrench_publisher_, seal_publisher_, pressure_publisher_;
};

}  // namespace vacuum_gripper_sim
