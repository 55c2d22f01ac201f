#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/// What the mount and the regulator are asked to do at one time.
struct Keyframe {
  double time{0.0};                               ///< [s] >= 0
  Eigen::Vector3d p_WM{Eigen::Vector3d::Zero()};  ///< Mount's origin in the world. [m]
  Eigen::Quaterniond q_WM{0.0, 1.0, 0.0, 0.0};    ///< Unit; default: z of the mount down.
  double pressure_setpoint{0.0};                  ///< Gauge, from this keyframe on. [Pa] <= 0
  bool smooth{false};  ///< The way here from the keyframe before begins and ends at rest.
};

/** Reads a list of keyframes `{time, position, rotation, pressure_setpoint, smooth}`; a keyframe
 without a set-point keeps the one before (zero at first), without a rotation it points down.
 @param name Dotted path of the list, for messages.
 @throws std::invalid_argument naming the keyframe: fewer than two, the first not at time zero,
 times not ascending, unknown keys, wrong types. */
std::vector<Keyframe> ReadTimeline(const YAML::Node& node, const std::string& name);

/// The same of an object that moves: no set-points, and without a rotation it is not turned.
std::vector<Keyframe> ReadMotion(const YAML::Node& node, const std::string& name);

/** The pose at a time: position interpolated linearly and orientation by slerp between the
 keyframes around it; on a smooth way the part s of it that is done at the part f of its time is s =
 f^2 (3 - 2 f). Before the first and after the last keyframe their poses hold.
 @pre at least one keyframe, times ascending. */
Eigen::Isometry3d PoseAt(const std::vector<Keyframe>& timeline, double time);

/// The command at a time: PoseAt(), and the set-point of the last keyframe that is not later.
Command CommandAt(const std::vector<Keyframe>& timeline, double time);

}  // namespace vacuum_gripper_sim
