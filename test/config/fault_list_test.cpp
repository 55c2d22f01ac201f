#include "vacuum_gripper_sim/config/fault_list.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

SimulatorParameters Gripper(const std::vector<std::string>& cups) {
  SimulatorParameters gripper;
  gripper.vacuum.source = VacuumSourceType::kPump;
  gripper.cups.clear();
  for (const std::string& name : cups) {
    gripper.cups.emplace_back();
    gripper.cups.back().name = name;
  }
  return gripper;
}

FaultCommand Break(const std::string& fault, const std::string& target, double value) {
  FaultCommand command;
  command.fault = fault;
  command.target = target;
  command.value = value;
  return command;
}

FaultCommand Mend(const std::string& fault, const std::string& target = "") {
  FaultCommand command = Break(fault, target, std::numeric_limits<double>::quiet_NaN());
  command.active = false;
  return command;
}

FaultCommand Dirt(double azimuth, double gap) {
  FaultCommand command = Break("dirty_lip", "left", gap);
  command.azimuth = azimuth;
  command.width = 0.5;
  return command;
}

TEST(FaultList, BreaksAndMends) {
  FaultList list(Gripper({"left", "right"}), {"table", "box"});
  std::vector<RigidObject> objects(2);
  objects[0].name = "table";
  objects[1].name = "box";
  EXPECT_EQ(list.Apply(Break("hose_kinked", "left", 0.25)), "hose_kinked at cup left");
  list.Apply(Break("cup_torn", "right", 1e-6));
  list.Apply(Break("porous_object", "box", 1e-9));
  list.Apply(Break("pump_lost", "", 0.0));
  list.Apply(Break("sensor_stuck", "", 0.0));
  VacuumFaults faults = list.ToFaults(objects);
  EXPECT_TRUE(faults.pump_lost);
  EXPECT_TRUE(faults.sensor_stuck);
  EXPECT_TRUE(list.sensor_stuck());
  ASSERT_EQ(faults.cups.size(), 2U);
  EXPECT_EQ(faults.cups[0].hose_opening, 0.25);
  EXPECT_EQ(faults.cups[0].torn_area, 0.0);
  EXPECT_EQ(faults.cups[1].hose_opening, 1.0);
  EXPECT_EQ(faults.cups[1].torn_area, 1e-6);
  EXPECT_EQ(faults.permeances, (std::vector<double>{0.0, 1e-9}));
  // An object that the simulator does not have yet.
  objects.pop_back();
  EXPECT_EQ(list.ToFaults(objects).permeances, (std::vector<double>{0.0}));

  EXPECT_EQ(list.Apply(Mend("hose_kinked", "left")), "hose_kinked mended at cup left");
  list.Apply(Mend("cup_torn", "right"));
  list.Apply(Mend("porous_object", "box"));
  list.Apply(Mend("pump_lost"));
  list.Apply(Mend("sensor_stuck"));
  faults = list.ToFaults(objects);
  EXPECT_FALSE(faults.pump_lost);
  EXPECT_FALSE(faults.sensor_stuck);
  EXPECT_EQ(faults.cups[0].hose_opening, 1.0);
  EXPECT_EQ(faults.cups[1].torn_area, 0.0);
  EXPECT_TRUE(faults.permeances.empty());
}

TEST(FaultList, DirtIsBySectors) {
  FaultList list(Gripper({"left", "right"}), {});
  list.Apply(Dirt(0.0, 1e-4));
  list.Apply(Dirt(1.0, 2e-4));
  list.Apply(Dirt(0.0, 3e-4));
  const VacuumFaults faults = list.ToFaults({});
  ASSERT_EQ(faults.cups[0].dirt.size(), 2U);
  EXPECT_EQ(faults.cups[0].dirt[0].gap, 3e-4);
  EXPECT_EQ(faults.cups[0].dirt[1].azimuth, 1.0);
  EXPECT_EQ(faults.cups[0].dirt[1].width, 0.5);
  EXPECT_TRUE(faults.cups[1].dirt.empty());
  list.Apply(Mend("dirty_lip", "left"));
  EXPECT_TRUE(list.ToFaults({}).cups[0].dirt.empty());
}

TEST(FaultList, TheOnlyOneNeedsNoName) {
  FaultList list(Gripper({""}), {"table"});
  EXPECT_EQ(list.Apply(Break("cup_torn", "", 1e-6)), "cup_torn at the cup");
  EXPECT_EQ(list.Apply(Break("porous_object", "", 1e-9)), "porous_object at object table");
  EXPECT_EQ(list.ToFaults({}).cups[0].torn_area, 1e-6);
}

TEST(FaultList, RefusalsNameTheFieldAndChangeNothing) {
  FaultList list(Gripper({"left", "right"}), {"table"});
  const auto error = [&](const FaultCommand& command) {
    return ErrorOf([&] { list.Apply(command); });
  };
  EXPECT_TRUE(Contains(error(Break("leak", "", 0.0)), "fault = 'leak'; expected one of pump_lost"));
  EXPECT_TRUE(Contains(error(Break("cup_torn", "", 1e-6)), "(left, right)"));
  EXPECT_TRUE(Contains(error(Break("cup_torn", "table", 1e-6)), "target = 'table'"));
  EXPECT_TRUE(Contains(error(Break("pump_lost", "left", 0.0)), "target = 'left'"));
  EXPECT_TRUE(Contains(error(Break("porous_object", "left", 1e-9)), "(table)"));
  EXPECT_TRUE(Contains(error(Break("cup_torn", "left", 0.0)), "value = 0"));
  EXPECT_TRUE(Contains(error(Break("cup_torn", "left", HUGE_VAL)), "value = inf"));
  EXPECT_TRUE(Contains(error(Break("hose_kinked", "left", 1.1)), "value = 1.1"));
  EXPECT_TRUE(Contains(error(Break("dirty_lip", "left", 1e-4)), "width = 0"));
  EXPECT_TRUE(Contains(error(Dirt(7.0, 1e-4)), "azimuth = 7"));
  EXPECT_TRUE(Contains(error(Break("porous_object", "table", -1.0)), "value = -1"));
  const VacuumFaults faults = list.ToFaults({});
  EXPECT_FALSE(faults.pump_lost);
  EXPECT_EQ(faults.cups[0].torn_area, 0.0);
  EXPECT_EQ(faults.cups[0].hose_opening, 1.0);
  EXPECT_TRUE(faults.cups[0].dirt.empty());
}

TEST(FaultList, TheIdealRegulatorHasNone) {
  SimulatorParameters gripper = Gripper({""});
  gripper.vacuum.source = VacuumSourceType::kIdealRegulator;
  FaultList list(gripper, {});
  EXPECT_TRUE(Contains(ErrorOf([&] { list.Apply(Break("cup_torn", "", 1e-6)); }),
                       "vacuum.source = ideal_regulator"));
  list.Apply(Break("sensor_stuck", "", 0.0));
  EXPECT_TRUE(list.sensor_stuck());
}

TEST(FaultEvents, AreReadWithTheirTimes) {
  const std::vector<FaultEvent> events = ReadFaultEvents(YAML::Load(R"(
- {fault: pump_lost}
- {time: 0.5, fault: dirty_lip, target: left, value: 1.0e-4, azimuth: 1.0, width: 0.2}
- {time: 0.5, fault: pump_lost, active: false}
)"),
                                                         "faults");
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].time, 0.0);
  EXPECT_TRUE(events[0].command.active);
  EXPECT_EQ(events[1].command.target, "left");
  EXPECT_EQ(events[1].command.value, 1e-4);
  EXPECT_EQ(events[1].command.azimuth, 1.0);
  EXPECT_EQ(events[1].command.width, 0.2);
  EXPECT_FALSE(events[2].command.active);

  const auto error = [](const std::string& yaml) {
    return ErrorOf([&] { ReadFaultEvents(YAML::Load(yaml), "faults"); });
  };
  EXPECT_TRUE(Contains(error("{fault: pump_lost}"), "expected a list of faults"));
  EXPECT_TRUE(Contains(error("[{time: 0.0}]"), "faults.0.fault is not set"));
  EXPECT_TRUE(Contains(error("[{fault: leak}]"), "faults.0.fault = leak"));
  EXPECT_TRUE(Contains(error("[{fault: pump_lost, value: x}]"), "faults.0.value = x"));
  EXPECT_TRUE(Contains(error("[{time: 1.0, fault: pump_lost}, {time: 0.5, fault: pump_lost}]"),
                       "faults.1.time = 0.5; expected 1 or later"));
  EXPECT_TRUE(
      Contains(ErrorOf([] { ReadFaults(YAML::Load("[{time: 1.0, fault: pump_lost}]"), "faults"); }),
               "faults.0.time is not a known key"));
}

}  // namespace
}  // namespace vacuum_gripper_sim
