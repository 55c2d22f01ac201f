// Source, hose, cup and leak together: where their curves cross, how fast they get there, and that
// no air is lost on the way.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "physics/gas_world.h"
#include "vacuum_gripper_sim/core/gas_flow.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kSetpoint = -6000.0;  // Pa

/// An ejector that a bell stands.
SimulatorParameters Ejector(double h = 0.01) {
  SimulatorParameters parameters = WithSource(VacuumSourceType::kEjector, h);
  parameters.vacuum.ejector = {2e-4, -12e3, {}};
  parameters.vacuum.pump = parameters.vacuum.ejector;
  return parameters;
}

void PressAndHold(double time, GripWorld* world) {
  world->MoveTo(Lifted(-0.001), 0.02, 0.0);
  world->Wait(0.1, 0.0);
  world->Wait(time, kSetpoint);
}

/// Where a leak through an orifice goes on through hose and ejector. [Pa, gauge]
struct Crossing {
  double cup{0.0}, manifold{0.0};
};
Crossing CrossingOf(double leak_area, const VacuumParameters& vacuum) {
  const auto drawn = [&](double manifold) {
    return kAmbient * SuctionFlow(vacuum.ejector, manifold - kAmbient);
  };
  const auto manifold_of = [&](double cup) {
    return FallingRoot(
        [&](double p) { return OrificeThroughput(vacuum.line.hose_area, cup, p) - drawn(p); },
        0.5 * kAmbient, cup);
  };
  const double cup = FallingRoot(
      [&](double p) { return OrificeThroughput(leak_area, kAmbient, p) - drawn(manifold_of(p)); },
      0.8 * kAmbient, kAmbient);
  return {cup - kAmbient, manifold_of(cup) - kAmbient};
}

TEST(GasSystem, AHoleInThePlateLeavesThePressureWhereTheCurvesCross) {
  for (const double area : {2e-7, 5e-7, 1e-6}) {
    RigidObject plate = Plate();
    plate.surfaces[0].holes = {{Eigen::Vector3d(0.002, 0.001, 0.0), area},
                               {Eigen::Vector3d(0.050, 0.0, 0.0), 1e-5}};  // beside the cup
    GripWorld world({plate}, kAbovePlate, Ejector());
    PressAndHold(1.0, &world);
    const StepResult& result = world.result();
    const Crossing expected = CrossingOf(area, world.simulator().parameters().vacuum);
    EXPECT_NEAR(result.gauge_pressure, expected.cup, 5e-3 * std::abs(expected.cup));
    EXPECT_NEAR(result.manifold_pressure, expected.manifold, 5e-3 * std::abs(expected.manifold));
    EXPECT_NEAR(result.leak_area, area, 1e-3 * area);
    EXPECT_NEAR(result.leak_flow, result.source_flow, 1e-3 * result.source_flow);
    std::printf("hole of %.1e m^2: cup %.0f Pa (%.0f), manifold %.0f Pa (%.0f)\n", area,
                result.gauge_pressure, expected.cup, result.manifold_pressure, expected.manifold);
  }
}

TEST(GasSystem, APorousPlateLeaksByDarcy) {
  RigidObject plate = Plate();
  plate.surfaces[0].permeance = 5e-6;  // m/(Pa s)
  GripWorld world({plate}, kAbovePlate, Ejector());
  PressAndHold(1.0, &world);
  const StepResult& result = world.result();
  const double p = kAmbient + result.gauge_pressure;
  const double flow = plate.surfaces[0].permeance * result.cavity_area *
                      (kAmbient * kAmbient - p * p) / (2.0 * kAmbient);
  EXPECT_LT(result.gauge_pressure, -1000.0);
  EXPECT_GT(result.gauge_pressure, -11e3);
  EXPECT_NEAR(result.leak_flow, flow, 1e-2 * flow);
  std::printf("porous: %.0f Pa, leak %.3e m^3/s (%.3e)\n", result.gauge_pressure, result.leak_flow,
              flow);
}

// Air out of a volume that the simulation itself reports, by the two nodes' equations in small
// steps.
TEST(GasSystem, EvacuatesAsTheTwoNodesEquationsSay) {
  SimulatorParameters parameters = Ejector(0.002);
  parameters.vacuum.line.dead_volume = 20e-6;
  parameters.vacuum.manifold_volume = 10e-6;
  const VacuumParameters& vacuum = parameters.vacuum;
  GripWorld world({Plate()}, kAbovePlate, parameters);
  world.MoveTo(Lifted(-0.001), 0.02, 0.0);
  world.Wait(0.2, 0.0);
  double volume = world.result().cavity_volume + vacuum.line.dead_volume;
  double in_cup = (kAmbient + world.result().gauge_pressure) * volume;
  double in_manifold = (kAmbient + world.result().manifold_pressure) * vacuum.manifold_volume;
  double time = 0.0;
  world.after_step = [&](const StepResult& result) {
    const double end = result.cavity_volume + vacuum.line.dead_volume;
    constexpr int kParts = 400;
    const double dt = 0.002 / kParts;
    for (int i = 1; i <= kParts; ++i) {
      time += dt;
      const double p_m = in_manifold / vacuum.manifold_volume;
      const double p = in_cup / (volume + (end - volume) * i / kParts);
      const double hose = OrificeThroughput(vacuum.line.hose_area, p, p_m);
      const double drawn = time < vacuum.valve.on_delay
                               ? -OrificeThroughput(vacuum.valve.vent_area, kAmbient, p_m)
                               : kAmbient * SuctionFlow(vacuum.ejector, p_m - kAmbient);
      in_cup -= dt * hose;
      in_manifold += dt * (hose - drawn);
    }
    volume = end;
    const double expected = in_cup / volume - kAmbient;
    // Half a sub-step of the network late, at 330 Pa/ms, and .5 % of it.
    EXPECT_NEAR(result.gauge_pressure, expected, 85.0 + 0.005 * std::abs(expected)) << time;
  };
  world.Wait(0.4, -11e3);
  EXPECT_LT(world.result().gauge_pressure, -11e3);
  EXPECT_EQ(world.undone_steps, 0);
}

TEST(GasSystem, NoAirIsLostInAWholeCycle) {
  for (const VacuumSourceType source :
       {VacuumSourceType::kRegulator, VacuumSourceType::kEjector, VacuumSourceType::kPump,
        VacuumSourceType::kPassive, VacuumSourceType::kVented}) {
    SimulatorParameters parameters = Ejector();
    parameters.vacuum.source = source;
    for (const double roughness : {0.0, 20e-6}) {
      GripWorld world({Plate(roughness)}, kAbovePlate, parameters);
      const AirWatch watch(&world);
      PressAndHold(0.3, &world);
      world.MoveTo(Lifted(0.012), 0.01, kSetpoint);
      world.Wait(0.3, 0.0);
      EXPECT_LT(watch.largest_mass_error, 1e-9);
      EXPECT_EQ(world.undone_steps, 0);
      EXPECT_NEAR(world.result().gauge_pressure, 0.0, 5.0);
    }
  }
}

/// What an ejector's cycle comes to.
struct Cycle {
  double hold_pressure, hold_force, time_to_level, peak_force, lift;
};
Cycle RunCycle(double h, const char* bell) {
  constexpr double kLevel = -5000.0;  // Pa
  SimulatorParameters parameters = Ejector(h);
  parameters.vacuum.line.dead_volume = 30e-6;
  GripWorld world({Plate()}, kAbovePlate, parameters, bell);
  world.MoveTo(Lifted(-0.001), 0.02, 0.0);
  world.Wait(0.2, 0.0);
  Cycle cycle{0.0, 0.0, NAN, 0.0, NAN};
  double time = 0.0, last = 0.0;
  world.after_step = [&](const StepResult& result) {
    time += h;
    const double p = result.gauge_pressure;
    if (std::isnan(cycle.time_to_level) && p < kLevel) {
      cycle.time_to_level = time - h * (kLevel - p) / (last - p);
    }
    last = p;
    cycle.peak_force = std::max(cycle.peak_force, result.force_M.z());
    if (std::isnan(cycle.lift) && result.status == SealStatus::kLost) {
      cycle.lift = world.mount().z() - kCupLength;
    }
  };
  world.Wait(1.2, kSetpoint);
  cycle.hold_pressure = world.result().gauge_pressure;
  cycle.hold_force = world.result().force_M.z();
  world.MoveTo(Lifted(0.014), 0.005, kSetpoint);
  EXPECT_EQ(world.undone_steps, 0);
  return cycle;
}

void ExpectTheSameAtAllSteps(const char* bell, const std::vector<double>& steps) {
  const Cycle first = RunCycle(steps[0], bell);
  for (const double h : steps) {
    const Cycle cycle = h == steps[0] ? first : RunCycle(h, bell);
    std::printf("%s h = %2.0f ms: %.1f Pa, %.3f N, %.4f s to level, peak %.3f N, lost at %.2f mm\n",
                bell, 1e3 * h, cycle.hold_pressure, cycle.hold_force, cycle.time_to_level,
                cycle.peak_force, 1e3 * cycle.lift);
    const auto expect_near = [&](double value, double expected, const char* name) {
      EXPECT_NEAR(value, expected, 0.01 * std::abs(expected)) << name << ", h = " << h;
    };
    expect_near(cycle.hold_pressure, first.hold_pressure, "hold pressure");
    expect_near(cycle.hold_force, first.hold_force, "hold force");
    // Within a step the pressure is taken as linear; it falls by half of its way in one of 10 ms.
    EXPECT_NEAR(cycle.time_to_level, first.time_to_level, 0.01 * first.time_to_level + 0.12 * h)
        << "time to level, h = " << h;
    // The lip lets go slowly, in a motion that implicit Euler damps: first order in h.
    EXPECT_NEAR(cycle.peak_force, first.peak_force, (0.01 + 4.0 * h) * first.peak_force)
        << "peak force, h = " << h;
    EXPECT_NEAR(cycle.lift, first.lift, 1e-4 + 0.08 * h) << "lift, h = " << h;
  }
}

TEST(GasSystem, NothingDependsOnTheTimeStep) {
  ExpectTheSameAtAllSteps("linear_700", {0.001, 0.002, 0.005, 0.01});
}

TEST(GasSystem, NothingDependsOnTheTimeStepWithQuadraticElements) {
  ExpectTheSameAtAllSteps("quadratic_700", {0.002, 0.01});
}

}  // namespace
}  // namespace vacuum_gripper_sim
