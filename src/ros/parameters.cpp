#include "parameters.h"

#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "loop_priority.h"
#include "vacuum_gripper_sim/config/package_paths.h"
#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "vacuum_gripper_sim/config/simulator_config.h"
#include "vacuum_gripper_sim/config/vacuum_config.h"

namespace vacuum_gripper_sim {
namespace {

std::string Format(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

// What may be spent awake of a period: Linux takes 5 % of a core from a realtime_priority.
constexpr double kLongestBusyWait = 0.9;

// Everything the parameter file sets must be set: a default hidden in the code would turn a config
// that failed to load into a gripper that runs with other numbers than its owner believes.
struct Required {
  const char* section;  // Dotted; empty: top level.
  const char* key;
};
constexpr Required kRequired[] = {
    {"", "rate"},
    {"", "realtime_priority"},
    {"", "busy_wait"},
    {"", "world_frame"},
    {"", "cup_frame"},
    {"", "actuator"},
    {"", "cup"},
    {"", "display_rate"},
    {"", "margin_rate"},
    {"", "diagnostic_period"},
    {"", "ambient_pressure"},
    {"", "initial_position"},
    {"", "initial_rotation"},
    {"", "max_speed"},
    {"", "max_angular_speed"},
    {"", "longest_command_period"},
    {"", "gravity"},
    {"", "friction"},
    {"regulator", "default_pressure"},
    {"regulator", "min_pressure"},
    {"regulator", "ramp_rate"},
    {"contact", "solver"},
    {"contact", "tolerance"},
    {"contact", "acceptable_residual"},
    {"contact", "max_iterations"},
    {"contact", "relaxation"},
    {"contact", "alarm_distance"},
    {"seal", "max_rounds"},
    {"seal", "ramp_increments"},
    {"linear_solver", "method"},
    {"linear_solver", "precision"},
    {"linear_solver", "tolerance"},
    {"linear_solver", "position_tolerance"},
    {"linear_solver", "max_iterations"},
    {"linear_solver", "refactor_interval"},
    {"linear_solver", "threads"},
    {"vacuum", "source"},
    {"vacuum", "manifold_volume"},
    {"vacuum.regulator", "time_constant"},
    {"vacuum.regulator", "rate_limit"},
    {"vacuum.regulator", "supply_flow"},
    {"vacuum.ejector", "free_flow"},
    {"vacuum.ejector", "ultimate_vacuum"},
    {"vacuum.pump", "free_flow"},
    {"vacuum.pump", "ultimate_vacuum"},
    {"vacuum.valve", "on_delay"},
    {"vacuum.valve", "off_delay"},
    {"vacuum.valve", "blow_off_duration"},
    {"vacuum.valve", "blow_off_flow"},
    {"vacuum.valve", "vent_area"},
    {"vacuum.line", "dead_volume"},
    {"vacuum.line", "hose_area"},
    {"vacuum.line", "check_valve"},
    {"vacuum.sensor", "rate"},
    {"vacuum.sensor", "delay"},
    {"vacuum.sensor", "pressure_noise"},
    {"vacuum.sensor", "flow_noise"},
    {"vacuum.sensor", "pressure_resolution"},
    {"vacuum.sensor", "range_min"},
    {"vacuum.sensor", "range_max"},
    {"vacuum.sensor", "seed"},
    {"vacuum.sensor", "part_present_level"},
    {"vacuum.sensor", "part_detached_level"},
    {"vacuum.sensor", "hysteresis"},
    {"vacuum.sensor", "hold_time"},
};

/// The node below a dotted path; what is there of the way to it if it is no map. Null: nothing.
YAML::Node FindSection(const YAML::Node& root, const std::string& path) {
  YAML::Node node;
  node.reset(root);
  std::istringstream keys(path);
  for (std::string key; std::getline(keys, key, '.');) {
    if (!node.IsMap()) break;
    const YAML::Node below = std::as_const(node)[key];
    if (!below.IsDefined()) return YAML::Node();
    node.reset(below);
  }
  return node;
}

void CheckAllSet(const YAML::Node& root) {
  for (const Required& required : kRequired) {
    const std::string section = required.section;
    // Of a gripper that says nothing of its vacuum system it is the ideal regulator, which needs
    // none of these numbers.
    if (section.compare(0, 6, "vacuum") == 0 && !root["vacuum"].IsDefined()) continue;
    const YAML::Node parent = FindSection(root, section);
    const std::string name = section.empty() ? required.key : section + "." + required.key;
    if (parent.IsDefined() && !parent.IsNull() && !parent.IsMap()) {
      continue;  // Of the wrong type: the reader says so, with the value.
    }
    if (!parent.IsDefined() || !parent.IsMap() || !parent[required.key].IsDefined()) {
      throw std::invalid_argument("parameter " + name +
                                  " is not set; config/vacuum_gripper.yaml explains it");
    }
  }
}

/// A number from 0, itself included or not, up to `maximum`.
double GetBounded(ParameterReader* reader, const std::string& key, bool may_be_zero,
                  double maximum) {
  const double value = reader->GetDouble(key);
  if (!((value > 0.0 || (may_be_zero && value == 0.0)) && value <= maximum)) {
    throw std::invalid_argument("parameter " + reader->Name(key) + " = " + Format(value) +
                                " must be " + (may_be_zero ? ">= 0" : "> 0") +
                                " and <= " + Format(maximum));
  }
  return value;
}

double GetPositive(ParameterReader* reader, const std::string& key, double maximum) {
  return GetBounded(reader, key, false, maximum);
}

double GetNonNegative(ParameterReader* reader, const std::string& key, double maximum) {
  return GetBounded(reader, key, true, maximum);
}

int GetRealtimePriority(ParameterReader* reader) {
  const std::string key = "realtime_priority";
  const int priority = reader->GetInt(key);
  if (priority < 0 || priority > LoopPriority::kHighest) {
    throw std::invalid_argument("parameter " + reader->Name(key) + " = " +
                                std::to_string(priority) +
                                " must be >= 0 and <= " + std::to_string(LoopPriority::kHighest));
  }
  return priority;
}

// A number is no name, though YAML would print it as one.
std::string GetText(ParameterReader* reader, const std::string& key) {
  const YAML::Node value = reader->GetNode(key);
  if (!value.IsScalar() || value.Tag() != "!") {
    throw std::invalid_argument("parameter " + reader->Name(key) + " = " + YAML::Dump(value) +
                                " must be text");
  }
  return value.Scalar();
}

std::string GetFrame(ParameterReader* reader, const std::string& key) {
  const std::string frame = GetText(reader, key);
  if (frame.empty() || frame.front() == '/') {
    throw std::invalid_argument("parameter " + reader->Name(key) + " = '" + frame +
                                "' must be the name of a tf frame, without a leading slash");
  }
  return frame;
}

void CheckConsistency(const NodeParameters& parameters) {
  const std::string& cup_frame = parameters.cup_frame;
  if (cup_frame == parameters.world_frame) {
    throw std::invalid_argument("parameter cup_frame = '" + cup_frame +
                                "' must be another frame than world_frame");
  }
  const double ambient_pressure = parameters.simulator.vacuum.ambient_pressure;
  if (parameters.simulator.regulator.min_pressure < -ambient_pressure) {
    throw std::invalid_argument("parameter regulator.min_pressure = " +
                                Format(parameters.simulator.regulator.min_pressure) +
                                " must be >= -ambient_pressure = " + Format(-ambient_pressure) +
                                ", a perfect vacuum");
  }
}

}  // namespace

YAML::Node ToYaml(const XmlRpc::XmlRpcValue& value, const std::string& name) {
  XmlRpc::XmlRpcValue copy = value;  // Its accessors are not const.
  switch (copy.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(copy));
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(static_cast<int>(copy));
    case XmlRpc::XmlRpcValue::TypeDouble: {
      // Always with a point or exponent: 100.0 stays a real number, 1e400 and nan stay visible.
      const std::string text = Format(static_cast<double>(copy));
      const bool bare_integer = text.find_first_not_of("-0123456789") == std::string::npos;
      return YAML::Node(bare_integer ? text + ".0" : text);
    }
    case XmlRpc::XmlRpcValue::TypeString: {
      YAML::Node node(static_cast<std::string>(copy));
      node.SetTag("!");
      return node;
    }
    case XmlRpc::XmlRpcValue::TypeArray: {
      YAML::Node node(YAML::NodeType::Sequence);
      for (int i = 0; i < copy.size(); ++i) {
        node.push_back(ToYaml(copy[i], name + "[" + std::to_string(i) + "]"));
      }
      return node;
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      YAML::Node node(YAML::NodeType::Map);
      for (auto& [key, member] : copy) {
        node[key] = ToYaml(member, name.empty() ? key : name + "." + key);
      }
      return node;
    }
    default:
      throw std::invalid_argument(
          "parameter " + name +
          " has a type that is not supported; allowed: booleans, numbers, text, lists, maps");
  }
}

NodeParameters ReadNodeParameters(const ros::NodeHandle& private_nh) {
  XmlRpc::XmlRpcValue value;
  YAML::Node node(YAML::NodeType::Map);
  if (private_nh.getParam(private_nh.getNamespace(), value)) {
    node = ToYaml(value, "");
  }
  return ReadNodeParameters(node, ShareDirectory() + "/config/cups");
}

NodeParameters ReadNodeParameters(const YAML::Node& node, const std::string& cup_directory) {
  CheckAllSet(node);
  ParameterReader reader(node);
  NodeParameters parameters;
  parameters.rate = GetPositive(&reader, "rate", 1.0e+4);
  if (parameters.rate < 10.0) {
    std::ostringstream reason;
    reason << "parameter rate = " << parameters.rate << " must be >= 10 and <= 10000 [Hz]";
    throw std::invalid_argument(reason.str());
  }
  parameters.realtime_priority = GetRealtimePriority(&reader);
  parameters.busy_wait = GetNonNegative(&reader, "busy_wait", kLongestBusyWait / parameters.rate);
  parameters.world_frame = GetFrame(&reader, "world_frame");
  parameters.cup_frame = GetFrame(&reader, "cup_frame");
  const std::string actuator = reader.GetChoice("actuator", {"pose_command", "tf"}, "pose_command");
  const std::string mount_frame =
      reader.Has("mount_frame") ? GetText(&reader, "mount_frame") : std::string();
  if (actuator == "tf") {
    parameters.actuator = ActuatorSource::kTf;
    if (mount_frame.empty()) {
      throw std::invalid_argument(
          "parameter mount_frame is not set; with actuator = tf it must be the name of a tf frame");
    }
    parameters.mount_frame = GetFrame(&reader, "mount_frame");
  }
  parameters.margin_rate = GetPositive(&reader, "margin_rate", 1.0e+3);
  parameters.display_rate = GetPositive(&reader, "display_rate", 1.0e+3);
  GetPositive(&reader, "ambient_pressure", 1.0e+8);
  parameters.X_WM.translation() = reader.GetVector3("initial_position");
  parameters.X_WM.linear() =
      reader.GetRotation("initial_rotation", Eigen::Quaterniond::Identity()).toRotationMatrix();
  parameters.motion_limits.max_speed = GetPositive(&reader, "max_speed", 100.0);
  parameters.motion_limits.max_angular_speed = GetPositive(&reader, "max_angular_speed", 1.0e+3);
  parameters.motion_limits.longest_command_period =
      GetNonNegative(&reader, "longest_command_period", 10.0);

  parameters.cup = ReadCup(reader.GetNode("cup"), cup_directory, cup_directory);
  parameters.simulator = ReadSimulatorParameters(&reader);
  parameters.simulator.time_step = 1.0 / parameters.rate;
  const VacuumSystem vacuum = ReadVacuumSystem(&reader);
  parameters.simulator.vacuum = vacuum.parameters;
  parameters.sensor = vacuum.sensor;
  const YAML::Node faults = reader.GetNode("faults");
  if (reader.Has("faults")) parameters.faults = ReadFaults(faults, reader.Name("faults"));
  parameters.simulator.material = parameters.cup.material;
  parameters.simulator.damping = parameters.cup.damping;
  if (reader.Has("scene_description")) {
    parameters.scene_description = GetText(&reader, "scene_description");
  }
  parameters.surface_defaults = ReadSurfaceDefaults(&reader);
  parameters.diagnostic_period = GetPositive(&reader, "diagnostic_period", 1.0e+3);
  reader.CheckNoUnknownKeys();
  Validate(parameters.simulator);
  CheckConsistency(parameters);
  return parameters;
}

}  // namespace vacuum_gripper_sim
