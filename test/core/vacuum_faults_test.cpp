#include "vacuum_gripper_sim/core/vacuum_faults.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "mesh_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

TEST(VacuumFaults, NothingAndWhatIsPossibleIsAccepted) {
  EXPECT_NO_THROW(Validate(VacuumFaults(), 0, 0));
  VacuumFaults faults;
  faults.pump_lost = faults.sensor_stuck = true;
  faults.cups.resize(2);
  faults.cups[1] = {0.0, 1e-6, {{-9.0, 6.28, 1e-4}}};
  faults.permeances = {0.0, 1e-8};
  EXPECT_NO_THROW(Validate(faults, 2, 2));
  EXPECT_NO_THROW(Validate(faults, 4, 3));  // the others have none
}

TEST(VacuumFaults, EveryWrongNumberIsNamed) {
  const auto refuse = [](const std::function<void(VacuumFaults*)>& spoil, const char* field,
                         const char* value) {
    VacuumFaults faults;
    faults.cups.resize(2);
    faults.cups[1].dirt.resize(1);
    faults.permeances = {0.0, 0.0};
    spoil(&faults);
    ExpectInvalid([&] { Validate(faults, 2, 2); }, {field, value});
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refuse([](VacuumFaults* f) { f->cups.resize(3); }, "faults.cups", "3");
  refuse([](VacuumFaults* f) { f->permeances.resize(5); }, "faults.permeances", "5");
  refuse([](VacuumFaults* f) { f->cups[1].hose_opening = 1.5; }, "faults.cups[1].hose_opening",
         "1.5");
  refuse([](VacuumFaults* f) { f->cups[0].hose_opening = -0.5; }, "faults.cups[0].hose_opening",
         "-0.5");
  refuse([&](VacuumFaults* f) { f->cups[0].hose_opening = nan; }, "faults.cups[0].hose_opening",
         "nan");
  refuse([](VacuumFaults* f) { f->cups[0].torn_area = -2.0; }, "faults.cups[0].torn_area", "-2");
  refuse([](VacuumFaults* f) { f->cups[1].dirt[0].width = 7.0; }, "faults.cups[1].dirt[0].width",
         "7");
  refuse([&](VacuumFaults* f) { f->cups[1].dirt[0].azimuth = nan; },
         "faults.cups[1].dirt[0].azimuth", "nan");
  refuse([](VacuumFaults* f) { f->cups[1].dirt[0].gap = -0.25; }, "faults.cups[1].dirt[0].gap",
         "-0.25");
  refuse([](VacuumFaults* f) { f->permeances[1] = -0.125; }, "faults.permeances[1]", "-0.125");
}

}  // namespace
}  // namespace vacuum_gripper_sim
