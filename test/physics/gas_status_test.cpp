// What the grip says of itself, what faults do to it and that it recovers; that no source,
// set-point, roughness or tilt upsets the step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "physics/gas_world.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kSetpoint = -6000.0;  // Pa
using Statuses = std::vector<SealStatus>;

SimulatorParameters Source(VacuumSourceType source, double ultimate_vacuum = -12e3) {
  SimulatorParameters parameters = WithSource(source);
  parameters.vacuum.ejector = {2e-4, ultimate_vacuum, {}};
  parameters.vacuum.pump = {1e-4, ultimate_vacuum, {}};
  return parameters;
}

GripWorld Held(const SimulatorParameters& parameters, double setpoint = kSetpoint) {
  GripWorld world({Plate()}, kAbovePlate, parameters);
  world.MoveTo(Lifted(-0.001), 0.02, 0.0);
  world.Wait(0.1, 0.0);
  world.Wait(0.5, setpoint);
  return world;
}

VacuumFaults OfTheCup(const CupFaults& cup) {
  VacuumFaults faults;
  faults.cups = {cup};
  return faults;
}

TEST(GasStatus, APlainCycleTakesEveryStateOnce) {
  for (const VacuumSourceType source :
       {VacuumSourceType::kRegulator, VacuumSourceType::kEjector, VacuumSourceType::kPump}) {
    GripWorld world({Plate()}, kAbovePlate, Source(source));
    const AirWatch watch(&world);
    world.MoveTo(Lifted(-0.001), 0.02, 0.0);
    world.Wait(0.1, 0.0);
    EXPECT_EQ(watch.statuses, Statuses{SealStatus::kOpen});
    world.Wait(0.5, kSetpoint);
    EXPECT_EQ(watch.statuses,
              (Statuses{SealStatus::kOpen, SealStatus::kRegulating, SealStatus::kSealed}));
    world.MoveTo(Lifted(0.014), 0.01, kSetpoint);
    world.Wait(0.1, kSetpoint);
    EXPECT_EQ(world.result().status, SealStatus::kLost);
    world.Wait(0.3, 0.0);
    EXPECT_EQ(world.result().status, SealStatus::kOpen);
    EXPECT_EQ(std::count(watch.statuses.begin(), watch.statuses.end(), SealStatus::kLost), 1);
    EXPECT_EQ(std::count(watch.statuses.begin(), watch.statuses.end(), SealStatus::kSealed), 1);
    EXPECT_EQ(world.undone_steps, 0);
  }
}

TEST(GasStatus, IsOpenInTheAirWhateverTheSetPoint) {
  GripWorld world({Plate()}, Lifted(0.01), Source(VacuumSourceType::kEjector));
  const AirWatch watch(&world);
  world.Wait(0.2, kSetpoint);
  EXPECT_EQ(watch.statuses, Statuses{SealStatus::kOpen});
  EXPECT_GT(world.result().source_flow, 1e-4);
  EXPECT_GT(world.result().gauge_pressure, -100.0);
}

TEST(GasStatus, AnEjectorAtItsUltimateVacuumRegulatesAndThenIsSealed) {
  GripWorld world({Plate()}, kAbovePlate, Source(VacuumSourceType::kEjector, -8e3));
  const AirWatch watch(&world);
  world.MoveTo(Lifted(-0.001), 0.02, 0.0);
  world.Wait(0.1, 0.0);
  world.Wait(1.0, -8e3);
  EXPECT_EQ(watch.statuses,
            (Statuses{SealStatus::kOpen, SealStatus::kRegulating, SealStatus::kSealed}));
}

TEST(GasStatus, ATornCupLeaksWhereTheEjectorIsTooWeakAndRecovers) {
  GripWorld world = Held(Source(VacuumSourceType::kEjector));
  ASSERT_EQ(world.result().status, SealStatus::kSealed);
  CupFaults torn;
  torn.torn_area = 1.2e-6;
  world.simulator().SetFaults(OfTheCup(torn));
  world.Wait(0.5, kSetpoint);
  EXPECT_EQ(world.result().status, SealStatus::kLeaking);
  EXPECT_NEAR(world.result().leak_area, torn.torn_area, 1e-9);
  EXPECT_GT(world.result().gauge_pressure, kSetpoint);
  EXPECT_LT(world.result().gauge_pressure, 0.1 * kSetpoint);
  world.simulator().SetFaults(VacuumFaults());
  world.Wait(0.5, kSetpoint);
  EXPECT_EQ(world.result().status, SealStatus::kSealed);
}

TEST(GasFaults, ALostPumpLosesTheGripOfAnEjectorAndNotThatOfAPump) {
  VacuumFaults lost;
  lost.pump_lost = true;
  GripWorld ejector = Held(Source(VacuumSourceType::kEjector));
  ejector.simulator().SetFaults(lost);
  ejector.Wait(0.3, kSetpoint);
  EXPECT_EQ(ejector.result().status, SealStatus::kLost);
  EXPECT_GT(ejector.result().gauge_pressure, -50.0);
  ejector.simulator().SetFaults(VacuumFaults());
  ejector.Wait(0.5, kSetpoint);
  EXPECT_EQ(ejector.result().status, SealStatus::kSealed);

  GripWorld pump = Held(Source(VacuumSourceType::kPump));
  const double held = pump.result().gauge_pressure;
  pump.simulator().SetFaults(lost);
  pump.Wait(0.3, kSetpoint);
  EXPECT_EQ(pump.result().status, SealStatus::kSealed);
  EXPECT_NEAR(pump.result().gauge_pressure, held, 0.01 * std::abs(held));
}

TEST(GasFaults, AKinkedHoseKeepsTheVacuumInTheCupAndTheSourceOut) {
  GripWorld world = Held(Source(VacuumSourceType::kEjector));
  const double held = world.result().gauge_pressure;
  CupFaults kinked;
  kinked.hose_opening = 0.0;
  world.simulator().SetFaults(OfTheCup(kinked));
  world.Wait(0.3, 0.0);  // switched off: the cup does not learn of it
  EXPECT_NEAR(world.result().gauge_pressure, held, 0.01 * std::abs(held));
  EXPECT_NEAR(world.result().manifold_pressure, 0.0, 20.0);
  world.simulator().SetFaults(VacuumFaults());
  world.Wait(0.2, 0.0);
  EXPECT_NEAR(world.result().gauge_pressure, 0.0, 20.0);
}

TEST(GasFaults, DirtLeaksByTheCubeOfItsGapAndInProportionToItsWidth) {
  const auto leak_of = [](double width, double gap) {
    GripWorld world = Held(Source(VacuumSourceType::kRegulator));
    CupFaults dirty;
    dirty.dirt = {{1.0, width, gap}};
    world.simulator().SetFaults(OfTheCup(dirty));
    world.Wait(0.3, kSetpoint);
    const double flow = world.result().leak_flow;
    EXPECT_LT(world.result().gauge_pressure, 0.9 * kSetpoint);
    world.simulator().SetFaults(VacuumFaults());
    world.Wait(0.3, kSetpoint);
    EXPECT_EQ(world.result().status, SealStatus::kSealed);
    EXPECT_EQ(world.result().leak_flow, 0.0);
    return flow;
  };
  const double thin = leak_of(0.5, 20e-6), wide = leak_of(1.0, 20e-6), thick = leak_of(0.5, 40e-6);
  EXPECT_GT(thin, 0.0);
  EXPECT_NEAR(wide / thin, 2.0, 0.1);
  EXPECT_NEAR(thick / thin, 8.0, 1.0);
  std::printf("dirt of 20 um: %.2e m^3/s, twice as wide: %.2f, as thick: %.2f times\n", thin,
              wide / thin, thick / thin);
}

TEST(GasFaults, APlateThatBecomesPorousLetsAirInAndRecovers) {
  GripWorld world = Held(Source(VacuumSourceType::kEjector));
  VacuumFaults porous;
  porous.permeances = {2e-6};
  world.simulator().SetFaults(porous);
  world.Wait(0.5, kSetpoint);
  EXPECT_GT(world.result().leak_flow, 1e-5);
  EXPECT_GT(world.result().gauge_pressure, -11e3);
  world.simulator().SetFaults(VacuumFaults());
  world.Wait(0.8, kSetpoint);
  EXPECT_EQ(world.result().leak_flow, 0.0);
  EXPECT_LT(world.result().gauge_pressure, -11.5e3);
}

// Set-points that the bell bears; deeper ones crush it, and what is left of it after the pull-off
// is a matter for the contacts.
TEST(GasStability, NoStepFailsWhateverTheSourceSurfaceAndTilt) {
  for (const VacuumSourceType source :
       {VacuumSourceType::kRegulator, VacuumSourceType::kEjector, VacuumSourceType::kPump,
        VacuumSourceType::kPassive, VacuumSourceType::kVented}) {
    for (const double vacuum : {-1e3, -6e3, -30e3}) {
      for (const double roughness : {0.0, 5e-6, 30e-6}) {
        GripWorld world({Plate(roughness, 0.5)}, kAbovePlate, Source(source, vacuum));
        if (roughness == 5e-6) world.Turn(5.0 * M_PI / 180.0);
        const AirWatch watch(&world);
        world.MoveTo(Lifted(-0.001), 0.02, 0.0);
        world.Wait(0.1, 0.0);
        world.Wait(0.3, vacuum);
        world.MoveTo(Lifted(0.012), 0.02, vacuum);
        world.Wait(0.2, 0.0);
        const std::string what = std::to_string(static_cast<int>(source)) + " at " +
                                 std::to_string(vacuum) + " on " + std::to_string(1e6 * roughness);
        EXPECT_EQ(world.undone_steps, 0) << what;
        EXPECT_LE(watch.unbalanced_steps, 5) << what;  // the lip snaps on, the lip snaps off
        EXPECT_LT(watch.largest_mass_error, 1e-9) << what;
        EXPECT_LT(world.max_penetration, 1e-6) << what;
      }
    }
  }
}

TEST(GasStability, APlateThatComesAndGoesIsHeldAsOneThatStays) {
  GripWorld world = Held(Source(VacuumSourceType::kEjector));
  const double force = world.result().force_M.z(), pressure = world.result().gauge_pressure;
  const AirWatch watch(&world);
  Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 100; ++i) {  // down by 2 mm and back
    X_WO.translation().z() = -0.001 * (1.0 - std::cos(2.0 * M_PI * i / 100.0));
    world.simulator().SetObjectPose(0, X_WO);
    world.Step(kSetpoint);
    EXPECT_EQ(world.result().status, SealStatus::kSealed);
  }
  world.Wait(0.3, kSetpoint);
  EXPECT_NEAR(world.result().force_M.z(), force, 0.02 * force);
  EXPECT_NEAR(world.result().gauge_pressure, pressure, 0.01 * std::abs(pressure));
  EXPECT_LT(watch.largest_mass_error, 1e-9);
}

}  // namespace
}  // namespace vacuum_gripper_sim
