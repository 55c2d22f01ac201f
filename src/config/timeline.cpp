#include "vacuum_gripper_sim/config/timeline.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

// A step's time is a multiple of h, rounded: without this slack a set-point could act a step late.
constexpr double kTimeSlack = 1e-9;

enum class Moved { kMount, kObject };

/// @param setpoint Of the keyframe before.
Keyframe ReadKeyframe(Moved moved, ParameterReader reader, double setpoint) {
  Keyframe keyframe;
  keyframe.time = reader.GetDouble("time");
  keyframe.p_WM = reader.GetVector3("position");
  if (moved == Moved::kObject) keyframe.q_WM = Eigen::Quaterniond::Identity();
  keyframe.q_WM = reader.GetRotation("rotation", keyframe.q_WM);
  if (moved == Moved::kMount) {
    keyframe.pressure_setpoint = reader.GetDouble("pressure_setpoint", setpoint);
  }
  keyframe.smooth = reader.GetBool("smooth", false);
  reader.CheckNoUnknownKeys();
  return keyframe;
}

std::vector<Keyframe> ReadKeyframes(Moved moved, const YAML::Node& node, const std::string& name) {
  if (node.IsNull()) {
    throw std::invalid_argument(name + " is not set; expected a list of at least 2 keyframes");
  }
  if (!node.IsSequence() || node.size() < 2) {
    throw std::invalid_argument(name + " = " + Describe(node) +
                                "; expected a list of at least 2 keyframes");
  }
  std::vector<Keyframe> timeline;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const std::string path = name + "." + std::to_string(i);
    const double setpoint = i == 0 ? 0.0 : timeline.back().pressure_setpoint;
    timeline.push_back(ReadKeyframe(moved, ParameterReader(node[i], path), setpoint));
    const std::string value = path + ".time = " + Describe(node[i]["time"]);
    if (i == 0 && timeline[i].time != 0.0) {
      throw std::invalid_argument(value + "; expected 0, the first keyframe is the start");
    }
    if (i > 0 && timeline[i].time <= timeline[i - 1].time) {
      throw std::invalid_argument(value + "; expected more than the keyframe before (" +
                                  Describe(node[i - 1]["time"]) + ")");
    }
  }
  return timeline;
}

/// The last keyframe that is not later; of none, the first.
std::size_t Before(const std::vector<Keyframe>& timeline, double time) {
  std::size_t next = 0;
  while (next < timeline.size() && timeline[next].time <= time + kTimeSlack) ++next;
  return next == 0 ? 0 : next - 1;
}

}  // namespace

std::vector<Keyframe> ReadTimeline(const YAML::Node& node, const std::string& name) {
  return ReadKeyframes(Moved::kMount, node, name);
}

std::vector<Keyframe> ReadMotion(const YAML::Node& node, const std::string& name) {
  return ReadKeyframes(Moved::kObject, node, name);
}

Eigen::Isometry3d PoseAt(const std::vector<Keyframe>& timeline, double time) {
  const std::size_t index = Before(timeline, time);
  const Keyframe& before = timeline[index];
  const Keyframe& after = timeline[std::min(index + 1, timeline.size() - 1)];

  double fraction = 0.0;
  if (after.time > before.time) fraction = (time - before.time) / (after.time - before.time);
  if (fraction < 0.0) fraction = 0.0;
  if (after.smooth) fraction *= fraction * (3.0 - 2.0 * fraction);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = before.p_WM + fraction * (after.p_WM - before.p_WM);
  X.linear() = before.q_WM.slerp(fraction, after.q_WM).normalized().toRotationMatrix();
  return X;
}

Command CommandAt(const std::vector<Keyframe>& timeline, double time) {
  Command command;
  command.X_WM = PoseAt(timeline, time);
  command.pressure_setpoint = timeline[Before(timeline, time)].pressure_setpoint;
  return command;
}

}  // namespace vacuum_gripper_sim
