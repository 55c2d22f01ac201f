#include "vacuum_gripper_sim/config/vacuum_config.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

VacuumSystem Read(const std::string& yaml) {
  ParameterReader reader(YAML::Load(yaml));
  const VacuumSystem system = ReadVacuumSystem(&reader);
  reader.CheckNoUnknownKeys();
  return system;
}

TEST(VacuumConfig, NothingSetIsTheIdealRegulator) {
  const VacuumSystem read = Read("{}");
  const VacuumParameters expected;
  EXPECT_EQ(read.parameters.source, VacuumSourceType::kIdealRegulator);
  EXPECT_EQ(read.parameters.ambient_pressure, expected.ambient_pressure);
  EXPECT_EQ(read.parameters.pump.free_flow, expected.pump.free_flow);
  EXPECT_EQ(read.sensor.rate, VacuumSensorParameters().rate);
}

TEST(VacuumConfig, ReadsEveryKey) {
  const VacuumSystem read = Read(R"(
ambient_pressure: 90000.0
vacuum:
  source: pump
  regulator: {time_constant: 1.0, rate_limit: 2.0, supply_flow: 3.0}
  ejector: {free_flow: 4.0, ultimate_vacuum: -5.0}
  pump: {free_flow: 6.0, ultimate_vacuum: -7.0, table: [[0.0, 8.0], [-9.0, 0.0]]}
  valve: {on_delay: 10.0, off_delay: 11.0, blow_off_duration: 12.0, blow_off_flow: 13.0,
          vent_area: 14.0}
  manifold_volume: 15.0
  line: {dead_volume: 16.0, hose_area: 17.0, check_valve: true}
  sensor: {rate: 18.0, delay: 19.0, pressure_noise: 20.0, flow_noise: 21.0,
           pressure_resolution: 22.0, range_min: 23.0, range_max: 24.0, seed: 25,
           part_present_level: -30.0, part_detached_level: -26.0, hysteresis: 2.7, hold_time: 28.0}
)");
  const VacuumParameters& p = read.parameters;
  EXPECT_EQ(p.ambient_pressure, 90000.0);
  EXPECT_EQ(p.source, VacuumSourceType::kPump);
  EXPECT_EQ(p.regulator.time_constant, 1.0);
  EXPECT_EQ(p.regulator.rate_limit, 2.0);
  EXPECT_EQ(p.regulator.supply_flow, 3.0);
  EXPECT_EQ(p.ejector.free_flow, 4.0);
  EXPECT_EQ(p.ejector.ultimate_vacuum, -5.0);
  EXPECT_TRUE(p.ejector.table.empty());
  EXPECT_EQ(p.pump.free_flow, 6.0);
  EXPECT_EQ(p.pump.ultimate_vacuum, -7.0);
  ASSERT_EQ(p.pump.table.size(), 2U);
  EXPECT_EQ(p.pump.table[0].flow, 8.0);
  EXPECT_EQ(p.pump.table[1].vacuum, -9.0);
  EXPECT_EQ(p.valve.on_delay, 10.0);
  EXPECT_EQ(p.valve.off_delay, 11.0);
  EXPECT_EQ(p.valve.blow_off_duration, 12.0);
  EXPECT_EQ(p.valve.blow_off_flow, 13.0);
  EXPECT_EQ(p.valve.vent_area, 14.0);
  EXPECT_EQ(p.manifold_volume, 15.0);
  EXPECT_EQ(p.line.dead_volume, 16.0);
  EXPECT_EQ(p.line.hose_area, 17.0);
  EXPECT_TRUE(p.line.check_valve);
  const VacuumSensorParameters& sensor = read.sensor;
  EXPECT_EQ(sensor.rate, 18.0);
  EXPECT_EQ(sensor.delay, 19.0);
  EXPECT_EQ(sensor.pressure_noise, 20.0);
  EXPECT_EQ(sensor.flow_noise, 21.0);
  EXPECT_EQ(sensor.pressure_resolution, 22.0);
  EXPECT_EQ(sensor.range_min, 23.0);
  EXPECT_EQ(sensor.range_max, 24.0);
  EXPECT_EQ(sensor.seed, 25U);
  EXPECT_EQ(sensor.part_present_level, -30.0);
  EXPECT_EQ(sensor.part_detached_level, -26.0);
  EXPECT_EQ(sensor.hysteresis, 2.7);
  EXPECT_EQ(sensor.hold_time, 28.0);
}

TEST(VacuumConfig, KnowsEverySource) {
  const std::array<std::string, 6> names = {"ideal_regulator", "regulator", "ejector", "pump",
                                            "passive",         "vented"};
  const std::array<VacuumSourceType, 6> types = {
      VacuumSourceType::kIdealRegulator, VacuumSourceType::kRegulator, VacuumSourceType::kEjector,
      VacuumSourceType::kPump,           VacuumSourceType::kPassive,   VacuumSourceType::kVented};
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(Read("vacuum: {source: " + names[i] + "}").parameters.source, types[i]);
  }
}

TEST(VacuumConfig, RefusalsNameTheDottedPath) {
  const auto error = [](const std::string& yaml) { return ErrorOf([&] { Read(yaml); }); };
  EXPECT_TRUE(Contains(error("vacuum: {source: magic}"), "vacuum.source = magic; expected ideal_"));
  EXPECT_TRUE(Contains(error("vacuum: {pumps: {}}"), "vacuum.pumps is not a known key"));
  EXPECT_TRUE(
      Contains(error("vacuum: {valve: {delay: 1.0}}"), "vacuum.valve.delay is not a known"));
  EXPECT_TRUE(Contains(error("vacuum: {line: {hose_area: 0.0}}"), "vacuum.line.hose_area = 0"));
  EXPECT_TRUE(Contains(error("vacuum: {sensor: {seed: -1}}"), "vacuum.sensor.seed = -1"));
  EXPECT_TRUE(Contains(error("vacuum: {sensor: {rate: 0.0}}"), "vacuum.sensor.rate = 0"));
  EXPECT_TRUE(Contains(error("vacuum: {pump: {table: []}}"), "vacuum.pump.table = []"));
  EXPECT_TRUE(
      Contains(error("vacuum: {pump: {table: [[0, 1.0], [-1]]}}"), "vacuum.pump.table.1 = [-1]"));
  EXPECT_TRUE(Contains(error("vacuum: {pump: {table: [[0, x]]}}"), "vacuum.pump.table.0 = [0, x]"));
  EXPECT_TRUE(Contains(error("ambient_pressure: -1.0"), "ambient_pressure = -1.0"));
}

}  // namespace
}  // namespace vacuum_gripper_sim
