#include "vacuum_gripper_sim/config/timeline.h"

#include <cstddef>
#include <stdexcept>

#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

// A step's time is a multiple of h, rounded: without this slack a set-point could act a step late.
constexpr double kTimeSlack = 1e-9;

Keyframe ReadKeyframe(ParameterReader reader, double inherited_setpoint) {
  Keyframe keyframe;
  keyframe.time = reader.GetDouble("time");
  keyframe.p_WM = reader.GetVector3("position");
  keyframe.q_WM = reader.GetRotation("rotation", keyframe.q_WM);
  keyframe.pressure_setpoint = reader.GetDouble("pressure_setpoint", inherited_setpoint);
  reader.CheckNoUnknownKeys();
  return keyframe;
}

}  // namespace

std::vector<Keyframe> ReadTimeline(const YAML::Node& node, const std::string& name) {
  if (node.IsNull()) {
    throw std::invalid_argument(name + " is not set; expected a list of at least 2 keyframes");
  }
  if (!node.IsSequence() || node.size() < 2) {
    throw std::invalid_argument(name + " = " + Describe(node) +
                                "; expected a list of at least 2 keyframes");
  }
  std::vector<Keyframe> timeline;
  double setpoint = 0.0;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const std::string path = name + "." + std::to_string(i);
    timeline.push_back(ReadKeyframe(ParameterReader(node[i], path), setpoint));
    setpoint = timeline.back().pressure_setpoint;
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

Command CommandAt(const std::vector<Keyframe>& timeline, double time) {
  std::size_t next = 0;
  while (next < timeline.size() && timeline[next].time <= time + kTimeSlack) ++next;
  const Keyframe& before = timeline[next == 0 ? 0 : next - 1];
  const Keyframe& after = timeline[next == timeline.size() ? next - 1 : next];

  double fraction = 0.0;
  if (after.time > before.time) fraction = (time - before.time) / (after.time - before.time);
  if (fraction < 0.0) fraction = 0.0;
  Command command;
  command.X_WM.translation() = before.p_WM + fraction * (after.p_WM - before.p_WM);
  command.X_WM.linear() = before.q_WM.slerp(fraction, after.q_WM).normalized().toRotationMatrix();
  command.pressure_setpoint = before.pressure_setpoint;
  return command;
}

}  // namespace vacuum_gripper_sim
