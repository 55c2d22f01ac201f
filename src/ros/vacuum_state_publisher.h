#pragma once

#include <ros/node_handle.h>

#include <string>

#include "vacuum_gripper_sim/core/step_result.h"
#include "vacuum_gripper_sim/core/vacuum_sensor.h"

namespace vacuum_gripper_sim {

/// Reads the vacuum as the gripper's sensor does and publishes what it says on `~vacuum_state`
/// (latched). A sensor that is stuck repeats its last reading at its rate.
class VacuumStatePublisher {
 public:
  /// @param parameters Validated. @param ambient_pressure Absolute. [Pa]
  VacuumStatePublisher(ros::NodeHandle private_nh, const VacuumSensorParameters& parameters,
                       double ambient_pressure, const std::string& cup_frame);

  /// After every step. @param stamp Of its end. @param stuck Fault of the sensor.
  void OnStep(const ros::Time& stamp, const StepResult& result, bool stuck);
  void Reset() { sensor_.Reset(); }

 private:
  VacuumSensor sensor_;
  double period_;            // Of the readings. [s]
  double ambient_pressure_;  // Pa
  std::string frame_;
  double last_time_{0.0};  // Of what was published last. [s]
  ros::Publisher publisher_;
};

}  // namespace vacuum_gripper_sim
