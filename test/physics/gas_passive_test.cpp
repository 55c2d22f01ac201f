// A cup whose port is closed: its air follows Boyle and Mariotte, and comes in as the leak lets it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "physics/gas_world.h"

namespace vacuum_gripper_sim {
namespace {

/// The bell with a closed port and little air besides that under it.
SimulatorParameters Passive(double dead_volume = 1e-6, double h = 0.005) {
  SimulatorParameters parameters = WithSource(VacuumSourceType::kPassive, h);
  parameters.vacuum.line.dead_volume = dead_volume;
  parameters.vacuum.manifold_volume = 1e-6;
  return parameters;
}

/// Pressed down by `depth`, at rest there.
GripWorld Pressed(double depth, double roughness, const SimulatorParameters& parameters,
                  const char* bell = "linear_700") {
  GripWorld world({Plate(roughness)}, kAbovePlate, parameters, bell);
  world.MoveTo(Lifted(-depth), 0.01, 0.0);
  world.Wait(0.3, 0.0);
  return world;
}

/// p V with all that is behind the cup. [Pa m^3]
double PressureTimesVolume(const StepResult& result, const VacuumParameters& vacuum) {
  return (kAmbient + result.gauge_pressure) * (result.cavity_volume + vacuum.line.dead_volume) +
         (kAmbient + result.manifold_pressure) * vacuum.manifold_volume;
}

/// Between the cup and the plate: every column down to it. [m^3]
double GeometricVolume(const GripWorld& world) {
  const CavitySurface& cavity = const_cast<GripWorld&>(world).simulator().cavity();
  const Eigen::Matrix3Xd& x_W = world.result().x_W;
  const Eigen::Matrix3Xd areas = PointAreaVectors(cavity, x_W);
  double volume = 0.0;
  for (int i = 0; i < cavity.num_points(); ++i) {
    if (!world.result().classification.wet[static_cast<std::size_t>(i)]) continue;
    volume += x_W(2, cavity.nodes[static_cast<std::size_t>(i)]) * areas(2, i);
  }
  return volume;
}

TEST(GasPassive, PressureTimesVolumeStaysWhileTheCupIsPulled) {
  for (const char* const bell : {"linear_700", "quadratic_700"}) {
    GripWorld world = Pressed(0.002, 0.0, Passive(), bell);
    const VacuumParameters& vacuum = world.simulator().parameters().vacuum;
    const double sealed = PressureTimesVolume(world.result(), vacuum);
    int sealed_steps = 0;
    world.after_step = [&](const StepResult& result) {
      if (result.status != SealStatus::kSealed) return;
      ++sealed_steps;
      EXPECT_NEAR(PressureTimesVolume(result, vacuum), sealed, 1e-3 * sealed);
      const double volume = GeometricVolume(world);
      EXPECT_NEAR(result.cavity_volume, volume, 0.03 * volume);
    };
    world.MoveTo(Lifted(0.001), 0.005, 0.0);
    world.Wait(0.5, 0.0);
    EXPECT_EQ(world.result().status, SealStatus::kSealed);
    EXPECT_LT(world.result().gauge_pressure, -2000.0);
    EXPECT_GT(sealed_steps, 100);
    EXPECT_EQ(world.undone_steps, 0);
    std::printf("%s: held at %.0f Pa\n", bell, world.result().gauge_pressure);
  }
}

// From 0.5 mm above the plate to 2 mm pressed within a step: what was between is not in the cup.
TEST(GasPassive, ACupThatShutsWithinAStepBeginsWithWhatIsLeft) {
  for (const char* const bell : {"linear_700", "quadratic_700"}) {
    GripWorld world({Plate()}, kAbovePlate, Passive(), bell);
    const double open = GeometricVolume(world);
    world.MoveTo(Lifted(-0.002), 1.0, 0.0);
    world.Wait(0.3, 0.0);
    const double left = GeometricVolume(world);
    EXPECT_LT(left, 0.85 * open);
    EXPECT_NEAR(world.result().cavity_volume, left, 0.03 * left);
    EXPECT_EQ(world.undone_steps, 0);
  }
}

// N = p_0 (V_0 + V_d) of the press is all there is, whatever the lift: p = N / (V + V_d).
TEST(GasPassive, WhatIsPressedOutMakesTheForce) {
  double last_force = 0.0, last_pressure = 0.0;
  for (const double depth : {0.001, 0.002, 0.004}) {
    GripWorld world = Pressed(depth, 0.0, Passive());
    const double amount = world.result().gas_amount;
    double peak_force = 0.0, deepest = 0.0, lift = 0.0;
    world.after_step = [&](const StepResult& result) {
      if (result.status != SealStatus::kSealed) return;
      const double air = amount / (result.cavity_volume + 2e-6) - kAmbient;
      EXPECT_NEAR(result.gauge_pressure, air, 5.0 + 3e-3 * std::abs(air));
      peak_force = std::max(peak_force, result.force_M.z());
      deepest = std::min(deepest, result.gauge_pressure);
      lift = world.mount().z() - kCupLength;
    };
    world.MoveTo(Lifted(0.012), 0.01, 0.0);
    EXPECT_EQ(world.result().status, SealStatus::kLost);
    EXPECT_NEAR(world.result().gauge_pressure, 0.0, 50.0);
    EXPECT_GT(peak_force, 1.02 * last_force);
    EXPECT_LT(deepest, 1.02 * last_pressure);
    std::printf("pressed %.0f mm: peak %.2f N, %.0f Pa, lost at %.2f mm\n", 1e3 * depth, peak_force,
                deepest, 1e3 * lift);
    last_force = peak_force;
    last_pressure = deepest;
  }
}

/// How long the vacuum takes from `from` to `to`. [s]
double TimeBetween(double from, double to, double roughness, double dead_volume, double h) {
  GripWorld world = Pressed(0.002, roughness, Passive(dead_volume, h));
  world.MoveTo(Lifted(0.0005), 0.05, 0.0);
  double time = 0.0, started = NAN, ended = NAN, last = NAN;
  const auto crossed = [&](double level, double pressure) {
    return time - h * (pressure - level) / (pressure - last);
  };
  world.after_step = [&](const StepResult& result) {
    time += h;
    const double pressure = result.gauge_pressure;
    if (std::isnan(started) && last <= from && pressure > from) started = crossed(from, pressure);
    if (std::isnan(ended) && last <= to && pressure > to) ended = crossed(to, pressure);
    last = pressure;
  };
  while (std::isnan(ended) && time < 20.0) world.Wait(0.1, 0.0);
  return ended - started;
}

// The air that comes in is Q = K h_rms^3 (p_a^2 - p^2), with a K that depends on the state of the
// cup and that on p only: N = p (V(p) + V_d) rises along the same way, in a time that goes with
// h_rms^-3 and is linear in V_d.
TEST(GasPassive, TheVacuumLastsAsLongAsLeakAndVolumeSay) {
  const double h = 0.005;
  const double rough = TimeBetween(-1800.0, -1000.0, 4e-6, 4e-6, h);
  const double smooth = TimeBetween(-1800.0, -1000.0, 3e-6, 4e-6, h);
  const double larger = TimeBetween(-1800.0, -1000.0, 4e-6, 8e-6, h);
  const double largest = TimeBetween(-1800.0, -1000.0, 4e-6, 12e-6, h);
  std::printf("4 um: %.3f s, 3 um: %.3f s, 2 and 3 dead volumes: %.3f s, %.3f s\n", rough, smooth,
              larger, largest);
  EXPECT_GT(rough, 20.0 * h);
  EXPECT_NEAR(smooth / rough, std::pow(4.0 / 3.0, 3), 0.05 * std::pow(4.0 / 3.0, 3));
  EXPECT_GT(larger - rough, 0.1 * rough);
  EXPECT_NEAR(largest - larger, larger - rough, 0.1 * (larger - rough));
}

}  // namespace
}  // namespace vacuum_gripper_sim
