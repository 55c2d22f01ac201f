#include "vacuum_gripper_sim/core/vacuum_parameters.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace vacuum_gripper_sim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What Validate() says of the defaults changed by `change`; empty if they pass.
std::string Complaint(const std::function<void(VacuumParameters*)>& change) {
  VacuumParameters parameters;
  change(&parameters);
  try {
    Validate(parameters);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(VacuumParameters, DefaultsAreValidForEverySource) {
  for (int i = 0; i <= 5; ++i) {
    EXPECT_EQ(Complaint([&](auto* p) { p->source = static_cast<VacuumSourceType>(i); }), "");
  }
}

TEST(VacuumParameters, EachFieldIsNamedWithValueAndRule) {
  struct Field {
    std::string name;
    std::function<double*(VacuumParameters*)> get;
    bool zero_allowed;
  };
  const Field fields[] = {
      {"ambient_pressure", [](auto* p) { return &p->ambient_pressure; }, false},
      {"regulator.time_constant", [](auto* p) { return &p->regulator.time_constant; }, true},
      {"regulator.rate_limit", [](auto* p) { return &p->regulator.rate_limit; }, false},
      {"regulator.supply_flow", [](auto* p) { return &p->regulator.supply_flow; }, false},
      {"ejector.free_flow", [](auto* p) { return &p->ejector.free_flow; }, false},
      {"ejector.ultimate_vacuum", [](auto* p) { return &p->ejector.ultimate_vacuum; }, false},
      {"pump.free_flow", [](auto* p) { return &p->pump.free_flow; }, false},
      {"pump.ultimate_vacuum", [](auto* p) { return &p->pump.ultimate_vacuum; }, false},
      {"valve.on_delay", [](auto* p) { return &p->valve.on_delay; }, true},
      {"valve.off_delay", [](auto* p) { return &p->valve.off_delay; }, true},
      {"valve.blow_off_duration", [](auto* p) { return &p->valve.blow_off_duration; }, true},
      {"valve.blow_off_flow", [](auto* p) { return &p->valve.blow_off_flow; }, true},
      {"valve.vent_area", [](auto* p) { return &p->valve.vent_area; }, false},
      {"manifold_volume", [](auto* p) { return &p->manifold_volume; }, false},
      {"line.dead_volume", [](auto* p) { return &p->line.dead_volume; }, false},
      {"line.hose_area", [](auto* p) { return &p->line.hose_area; }, false},
  };
  for (const Field& field : fields) {
    const auto complaint = [&](double value) {
      return Complaint([&](auto* p) { *field.get(p) = value; });
    };
    for (const double bad : {-200000.0, kNan}) {
      const std::string text = complaint(bad);
      EXPECT_EQ(text.find("vacuum." + field.name + " = "), 0u) << field.name << ": " << text;
      EXPECT_NE(text.find("must be"), std::string::npos) << text;
    }
    EXPECT_EQ(complaint(0.0).empty(), field.zero_allowed) << field.name;
  }
  EXPECT_EQ(Complaint([](auto* p) {
              p->source = static_cast<VacuumSourceType>(6);
            }).find("vacuum.source = 6"),
            0u);
}

TEST(VacuumParameters, TablesAreChecked) {
  const auto complaint = [](const std::vector<SuctionPoint>& table) {
    return Complaint([&](auto* p) { p->pump.table = table; });
  };
  EXPECT_EQ(complaint({{0.0, 2e-4}, {-4e4, 1e-4}, {-7e4, 0.0}}), "");
  const std::string vacuum = "vacuum.pump.table.vacuum = ", flow = "vacuum.pump.table.flow = ";
  EXPECT_EQ(complaint({{-1e3, 2e-4}, {-7e4, 0.0}}).find(vacuum), 0u);               // no start
  EXPECT_EQ(complaint({{0.0, 2e-4}, {-4e4, 1e-4}, {-4e4, 0.0}}).find(vacuum), 0u);  // not deeper
  EXPECT_EQ(complaint({{0.0, 2e-4}, {-2e5, 0.0}}).find(vacuum), 0u);                // below nothing
  EXPECT_EQ(complaint({{0.0, 2e-4}, {-4e4, 3e-4}, {-7e4, 0.0}}).find(flow), 0u);    // rises
  EXPECT_EQ(complaint({{0.0, 2e-4}, {-7e4, 1e-5}}).find(flow), 0u);                 // does not end
  EXPECT_EQ(complaint({{0.0, 0.0}}).find(flow), 0u);
}

TEST(SuctionFlow, FallsLinearlyToTheUltimateVacuum) {
  const SuctionCurve line{2e-4, -8e4, {}};
  EXPECT_DOUBLE_EQ(SuctionFlow(line, 0.0), 2e-4);
  EXPECT_DOUBLE_EQ(SuctionFlow(line, 1e4), 2e-4);
  EXPECT_DOUBLE_EQ(SuctionFlow(line, -6e4), 0.5e-4);
  EXPECT_EQ(SuctionFlow(line, -9e4), 0.0);
}

TEST(SuctionFlow, FollowsItsTable) {
  const SuctionCurve curve{1.0, -1.0, {{0.0, 4e-4}, {-2e4, 3e-4}, {-8e4, 0.0}}};
  EXPECT_DOUBLE_EQ(SuctionFlow(curve, 1e3), 4e-4);
  EXPECT_DOUBLE_EQ(SuctionFlow(curve, -1e4), 3.5e-4);
  EXPECT_DOUBLE_EQ(SuctionFlow(curve, -2e4), 3e-4);
  EXPECT_NEAR(SuctionFlow(curve, -6e4), 1e-4, 1e-18);
  EXPECT_EQ(SuctionFlow(curve, -9e4), 0.0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
