#include "vacuum_gripper_sim/config/fault_list.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

const std::vector<std::string> kFaults = {"pump_lost", "hose_kinked",   "cup_torn",
                                          "dirty_lip", "porous_object", "sensor_stuck"};

std::string Join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

[[noreturn]] void Refuse(const std::string& field, const std::string& value,
                         const std::string& expected) {
  throw std::invalid_argument(field + " = " + value + "; expected " + expected);
}

std::string Format(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void RequireNumber(bool allowed, const char* field, double value, const std::string& expected) {
  if (!std::isfinite(value) || !allowed) Refuse(field, Format(value), expected);
}

/// Which of the names a target means.
std::size_t FindTarget(const std::string& target, const std::vector<std::string>& names,
                       const std::string& kind) {
  if (target.empty() && names.size() == 1) return 0;
  const auto found = std::find(names.begin(), names.end(), target);
  if (target.empty() || found == names.end()) {
    Refuse("target", "'" + target + "'", "the name of " + kind + " (" + Join(names) + ")");
  }
  return static_cast<std::size_t>(found - names.begin());
}

/// "cup left", "the cup".
std::string Call(const std::string& kind, const std::string& name) {
  return name.empty() ? "the " + kind : kind + " " + name;
}

void SetDirt(const FaultCommand& command, std::vector<DirtSector>* dirt) {
  if (!command.active) {
    dirt->clear();
    return;
  }
  RequireNumber(command.value > 0.0, "value", command.value, "the gap, more than 0 [m]");
  RequireNumber(std::abs(command.azimuth) <= 2.0 * M_PI, "azimuth", command.azimuth,
                "-2 pi to 2 pi [rad]");
  RequireNumber(command.width > 0.0 && command.width <= 2.0 * M_PI, "width", command.width,
                "more than 0, at most 2 pi [rad]");
  const auto same = std::find_if(dirt->begin(), dirt->end(), [&](const DirtSector& sector) {
    return sector.azimuth == command.azimuth;
  });
  const DirtSector sector{command.azimuth, command.width, command.value};
  if (same == dirt->end()) {
    dirt->push_back(sector);
  } else {
    *same = sector;
  }
}

}  // namespace

FaultCommand ReadFaultCommand(ParameterReader* reader) {
  FaultCommand command;
  command.fault = reader->GetString("fault");
  reader->GetChoice("fault", kFaults, "");
  command.active = reader->GetBool("active", command.active);
  command.target = reader->GetString("target", command.target);
  command.value = reader->GetDouble("value", command.value);
  command.azimuth = reader->GetDouble("azimuth", command.azimuth);
  command.width = reader->GetDouble("width", command.width);
  return command;
}

std::vector<FaultCommand> ReadFaults(const YAML::Node& node, const std::string& name) {
  if (!node.IsSequence()) Refuse(name, Describe(node), "a list of faults");
  std::vector<FaultCommand> commands;
  commands.reserve(node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    ParameterReader reader(node[i], name + "." + std::to_string(i));
    commands.push_back(ReadFaultCommand(&reader));
    reader.CheckNoUnknownKeys();
  }
  return commands;
}

std::vector<FaultEvent> ReadFaultEvents(const YAML::Node& node, const std::string& name) {
  if (!node.IsSequence()) Refuse(name, Describe(node), "a list of faults");
  std::vector<FaultEvent> events;
  events.reserve(node.size());
  double before = 0.0;
  for (std::size_t i = 0; i < node.size(); ++i) {
    ParameterReader reader(node[i], name + "." + std::to_string(i));
    FaultEvent event;
    event.time = reader.GetDouble("time", event.time);
    if (event.time < before) {
      Refuse(reader.Name("time"), Format(event.time), Format(before) + " or later [s]");
    }
    before = event.time;
    event.command = ReadFaultCommand(&reader);
    reader.CheckNoUnknownKeys();
    events.push_back(std::move(event));
  }
  return events;
}

FaultList::FaultList(std::vector<std::string> cups, std::vector<std::string> objects,
                     bool air_flows)
    : cups_(std::move(cups)), objects_(std::move(objects)), air_flows_(air_flows) {
  faults_.cups.resize(cups_.size());
}

std::string FaultList::Apply(const FaultCommand& command) {
  const std::string& fault = command.fault;
  if (std::find(kFaults.begin(), kFaults.end(), fault) == kFaults.end()) {
    Refuse("fault", "'" + fault + "'", "one of " + Join(kFaults));
  }
  if (!air_flows_ && fault != "sensor_stuck") {
    Refuse("fault", fault,
           "sensor_stuck only: vacuum.source = ideal_regulator imposes its pressure, whatever "
           "breaks");
  }
  if (fault == "porous_object") return ApplyToObject(command);
  if (fault != "pump_lost" && fault != "sensor_stuck") return ApplyToCup(command);
  if (!command.target.empty()) {
    Refuse("target", "'" + command.target + "'", "none, there is only one");
  }
  (fault == "pump_lost" ? faults_.pump_lost : faults_.sensor_stuck) = command.active;
  return fault + (command.active ? "" : " mended");
}

std::string FaultList::ApplyToCup(const FaultCommand& command) {
  const std::size_t index = FindTarget(command.target, cups_, "a cup");
  CupFaults& cup = faults_.cups[index];
  if (command.fault == "hose_kinked") {
    RequireNumber(!command.active || (command.value >= 0.0 && command.value <= 1.0), "value",
                  command.value, "the part of the hose's area that is left, 0 to 1 [-]");
    cup.hose_opening = command.active ? command.value : CupFaults().hose_opening;
  } else if (command.fault == "cup_torn") {
    RequireNumber(!command.active || command.value > 0.0, "value", command.value,
                  "the hole's effective orifice, more than 0 [m^2]");
    cup.torn_area = command.active ? command.value : CupFaults().torn_area;
  } else {
    SetDirt(command, &cup.dirt);
  }
  return command.fault + (command.active ? " at " : " mended at ") + Call("cup", cups_[index]);
}

std::string FaultList::ApplyToObject(const FaultCommand& command) {
  const std::string& name = objects_[FindTarget(command.target, objects_, "an object")];
  RequireNumber(!command.active || command.value > 0.0, "value", command.value,
                "the permeance, more than 0 [m/(Pa s)]");
  if (command.active) {
    permeances_[name] = command.value;
  } else {
    permeances_.erase(name);
  }
  return command.fault + (command.active ? " at " : " mended at ") + Call("object", name);
}

VacuumFaults FaultList::ToFaults(const std::vector<RigidObject>& objects) const {
  VacuumFaults faults = faults_;
  if (permeances_.empty()) return faults;  // of which the simulator takes notice
  faults.permeances.reserve(objects.size());
  for (const RigidObject& object : objects) {
    const auto found = permeances_.find(object.name);
    faults.permeances.push_back(found == permeances_.end() ? 0.0 : found->second);
  }
  return faults;
}

}  // namespace vacuum_gripper_sim
