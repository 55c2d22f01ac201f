#include "vacuum_gripper_sim/config/vacuum_config.h"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

// In the order of VacuumSourceType.
const std::vector<std::string> kSources = {"ideal_regulator", "regulator", "ejector", "pump",
                                           "passive",         "vented"};

VacuumSourceType ReadSource(ParameterReader* reader) {
  const std::string source = reader->GetChoice("source", kSources, kSources.front());
  std::size_t index = 0;
  while (kSources[index] != source) ++index;
  return static_cast<VacuumSourceType>(index);
}

VacuumRegulatorParameters ReadRegulator(ParameterReader reader) {
  VacuumRegulatorParameters p;
  p.time_constant = reader.GetDouble("time_constant", p.time_constant);
  p.rate_limit = reader.GetDouble("rate_limit", p.rate_limit);
  p.supply_flow = reader.GetDouble("supply_flow", p.supply_flow);
  reader.CheckNoUnknownKeys();
  return p;
}

std::vector<SuctionPoint> ReadTable(const YAML::Node& node, const std::string& path) {
  if (!node.IsSequence() || node.size() == 0) {
    throw std::invalid_argument(path + " = " + Describe(node) +
                                "; expected a list of [vacuum, flow]");
  }
  std::vector<SuctionPoint> table;
  table.reserve(node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    SuctionPoint point;
    const YAML::Node pair = node[i];
    if (!pair.IsSequence() || pair.size() != 2 || !pair[0].IsScalar() || !pair[1].IsScalar() ||
        !ParseDouble(pair[0].Scalar(), &point.vacuum) ||
        !ParseDouble(pair[1].Scalar(), &point.flow)) {
      throw std::invalid_argument(path + "." + std::to_string(i) + " = " + Describe(pair) +
                                  "; expected [vacuum, flow], two numbers [Pa], [m^3/s]");
    }
    table.push_back(point);
  }
  return table;
}

SuctionCurve ReadCurve(ParameterReader reader, SuctionCurve p) {
  p.free_flow = reader.GetDouble("free_flow", p.free_flow);
  p.ultimate_vacuum = reader.GetDouble("ultimate_vacuum", p.ultimate_vacuum);
  const YAML::Node table = reader.GetNode("table");
  if (reader.Has("table")) p.table = ReadTable(table, reader.Name("table"));
  reader.CheckNoUnknownKeys();
  return p;
}

VacuumValveParameters ReadValve(ParameterReader reader) {
  VacuumValveParameters p;
  p.on_delay = reader.GetDouble("on_delay", p.on_delay);
  p.off_delay = reader.GetDouble("off_delay", p.off_delay);
  p.blow_off_duration = reader.GetDouble("blow_off_duration", p.blow_off_duration);
  p.blow_off_flow = reader.GetDouble("blow_off_flow", p.blow_off_flow);
  p.vent_area = reader.GetDouble("vent_area", p.vent_area);
  reader.CheckNoUnknownKeys();
  return p;
}

CupLineParameters ReadLine(ParameterReader reader) {
  CupLineParameters p;
  p.dead_volume = reader.GetDouble("dead_volume", p.dead_volume);
  p.hose_area = reader.GetDouble("hose_area", p.hose_area);
  p.check_valve = reader.GetBool("check_valve", p.check_valve);
  reader.CheckNoUnknownKeys();
  return p;
}

VacuumSensorParameters ReadSensor(ParameterReader reader) {
  VacuumSensorParameters p;
  p.rate = reader.GetDouble("rate", p.rate);
  p.delay = reader.GetDouble("delay", p.delay);
  p.pressure_noise = reader.GetDouble("pressure_noise", p.pressure_noise);
  p.flow_noise = reader.GetDouble("flow_noise", p.flow_noise);
  p.pressure_resolution = reader.GetDouble("pressure_resolution", p.pressure_resolution);
  p.range_min = reader.GetDouble("range_min", p.range_min);
  p.range_max = reader.GetDouble("range_max", p.range_max);
  const int seed = reader.GetInt("seed", static_cast<int>(p.seed));
  if (seed < 0) {
    throw std::invalid_argument(reader.Name("seed") + " = " + std::to_string(seed) +
                                "; expected a whole number of 0 or more");
  }
  p.seed = static_cast<std::uint64_t>(seed);
  p.part_present_level = reader.GetDouble("part_present_level", p.part_present_level);
  p.part_detached_level = reader.GetDouble("part_detached_level", p.part_detached_level);
  p.hysteresis = reader.GetDouble("hysteresis", p.hysteresis);
  p.hold_time = reader.GetDouble("hold_time", p.hold_time);
  reader.CheckNoUnknownKeys();
  return p;
}

}  // namespace

VacuumSystem ReadVacuumSystem(ParameterReader* reader) {
  VacuumSystem system;
  VacuumParameters& p = system.parameters;
  p.ambient_pressure = reader->GetDouble("ambient_pressure", p.ambient_pressure);
  if (p.ambient_pressure <= 0.0) {
    throw std::invalid_argument(reader->Name("ambient_pressure") + " = " +
                                Describe(reader->GetNode("ambient_pressure")) +
                                "; expected more than 0 [Pa], absolute");
  }
  ParameterReader vacuum = reader->GetMap("vacuum");
  p.source = ReadSource(&vacuum);
  p.regulator = ReadRegulator(vacuum.GetMap("regulator"));
  p.ejector = ReadCurve(vacuum.GetMap("ejector"), p.ejector);
  p.pump = ReadCurve(vacuum.GetMap("pump"), p.pump);
  p.valve = ReadValve(vacuum.GetMap("valve"));
  p.manifold_volume = vacuum.GetDouble("manifold_volume", p.manifold_volume);
  p.line = ReadLine(vacuum.GetMap("line"));
  system.sensor = ReadSensor(vacuum.GetMap("sensor"));
  vacuum.CheckNoUnknownKeys();
  Validate(p);
  Validate(system.sensor);
  return system;
}

}  // namespace vacuum_gripper_sim
