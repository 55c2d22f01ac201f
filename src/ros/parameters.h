#pragma once

#include <XmlRpcValue.h>
#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "actuator.h"
#include "vacuum_gripper_sim/config/cup_file.h"
#include "vacuum_gripper_sim/config/fault_list.h"
#include "vacuum_gripper_sim/config/surface_defaults.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/vacuum_sensor.h"

namespace vacuum_gripper_sim {

/// Where the mount's pose comes from.
enum class ActuatorSource { kPoseCommand, kTf };

/// Everything the node reads from its private namespace; config/vacuum_gripper.yaml explains it.
struct NodeParameters {
  double rate{0.0};          ///< Steps per second of ROS time; h = 1 / rate. [Hz] > 0
  int realtime_priority{0};  ///< Of the loop's thread, see LoopPriority. 0 .. 99
  double busy_wait{0.0};     ///< How long the loop stays awake before a step. [s] 0 .. .9 / rate
  std::string world_frame;   ///< Inertial frame the cup is simulated in.
  std::string cup_frame;     ///< Frame of the mount and of the wrench.
  ActuatorSource actuator{ActuatorSource::kPoseCommand};
  std::string mount_frame;        ///< tf frame that the mount follows with kTf.
  double margin_rate{0.0};        ///< Of `~holding_margin`, at most. [Hz] > 0
  double display_rate{0.0};       ///< Of `~markers` and `~surface_points`. [Hz] > 0
  double diagnostic_period{0.0};  ///< Of /diagnostics. [s] > 0
  Eigen::Isometry3d X_WM{Eigen::Isometry3d::Identity()};  ///< Initial pose of the mount.
  MotionLimits motion_limits;
  Cup cup;
  SimulatorParameters simulator;  ///< Complete: the cup's material and h = 1 / rate filled in.
  VacuumSensorParameters sensor;
  std::vector<FaultCommand> faults;  ///< From the start on.
  std::string scene_description;     ///< URDF; empty: a plane.
  SurfaceDefaults surface_defaults;
};

/** Turns a parameter server's value into YAML, so that one strict reader serves node and tools.
 Strings carry the tag "!" (a quoted scalar): text that looks like a number stays text.
 @param name Parameter's name, for messages.
 @throws std::invalid_argument for types YAML has no plain form of (binary, date). */
YAML::Node ToYaml(const XmlRpc::XmlRpcValue& value, const std::string& name);

/** Reads and checks the parameters of a node.
 @throws std::invalid_argument with one line that names the parameter, its value and what is
 allowed: for one that is not set, mistyped, out of range, or unknown. */
NodeParameters ReadNodeParameters(const ros::NodeHandle& private_nh);

/// The same from YAML. @param cup_directory Directory of the package's cups.
NodeParameters ReadNodeParameters(const YAML::Node& node, const std::string& cup_directory);

}  // namespace vacuum_gripper_sim
