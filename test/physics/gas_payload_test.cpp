// Cups that share a manifold, and boxes that hang on them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "physics/gas_world.h"
#include "vacuum_gripper_sim/core/gas_flow.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kSetpoint = -6000.0;  // Pa

SimulatorParameters Lifter(int num_cups, double ultimate_vacuum = -12e3) {
  SimulatorParameters parameters = WithGravity(WithSource(VacuumSourceType::kEjector));
  parameters.vacuum.ejector = {4e-4, ultimate_vacuum, {}};
  if (num_cups == 1) return parameters;
  parameters.cups.clear();
  for (int i = 0; i < num_cups; ++i) {
    CupMount cup;
    cup.name = "cup_" + std::to_string(i);
    cup.X_MC.translation() << (i % 2 == 0 ? -0.03 : 0.03), (i < 2 ? -0.03 : 0.03), 0.0;
    parameters.cups.push_back(cup);
  }
  return parameters;
}

VacuumFaults FirstCupTorn(double area) {
  VacuumFaults faults;
  faults.cups.resize(1);
  faults.cups[0].torn_area = area;
  return faults;
}

TEST(GasPayload, ABoxIsLiftedHeldAndDroppedWhenTheSupplyFails) {
  const double mass = 0.2;
  GripWorld world({Table(0.5, Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -0.02))),
                   FreeBox({0.06, 0.06, 0.02}, mass, 0.5, {0.0, 0.0, -0.01})},
                  kAbovePlate, Lifter(1));
  const AirWatch watch(&world);
  world.MoveTo(Lifted(-0.001), 0.02, 0.0);
  world.Wait(0.5, kSetpoint);
  world.MoveTo(Lifted(0.02), 0.05, kSetpoint);
  world.Wait(1.0, kSetpoint);
  EXPECT_EQ(world.result().status, SealStatus::kSealed);
  EXPECT_NEAR(world.object(1).force_W.z(), mass * kGravity, 5e-3 * mass * kGravity);
  EXPECT_LT(world.object(1).velocity_W.norm(), 1e-4);
  EXPECT_GT(world.object(1).X_WO.translation().z(), 0.0);
  VacuumFaults lost;
  lost.pump_lost = true;
  world.simulator().SetFaults(lost);
  world.Wait(0.5, kSetpoint);
  EXPECT_EQ(world.result().status, SealStatus::kLost);
  EXPECT_LT(world.object(1).X_WO.translation().z(), -0.008);  // on the table
  EXPECT_EQ(world.undone_steps, 0);
  EXPECT_LT(watch.largest_mass_error, 1e-9);
}

/// Four cups on a plate; the first becomes torn. @returns the end's pressures. [Pa]
std::vector<double> FourCupsOneTorn(bool check_valve, double torn_area) {
  SimulatorParameters parameters = Lifter(4);
  parameters.gravity.setZero();
  parameters.vacuum.line.check_valve = check_valve;
  GripWorld world({Plate()}, kAbovePlate, parameters);
  const AirWatch watch(&world);
  world.MoveTo(Lifted(-0.001), 0.02, 0.0);
  world.Wait(0.1, 0.0);
  world.Wait(0.6, kSetpoint);
  for (const CupResult& cup : world.result().cups) EXPECT_LT(cup.gauge_pressure, -11e3);
  world.simulator().SetFaults(FirstCupTorn(torn_area));
  world.Wait(0.6, kSetpoint);
  EXPECT_EQ(world.undone_steps, 0);
  EXPECT_LT(watch.largest_mass_error, 1e-9);
  std::vector<double> pressures{world.result().manifold_pressure};
  for (const CupResult& cup : world.result().cups) pressures.push_back(cup.gauge_pressure);
  return pressures;
}

TEST(GasPayload, ATornCupWeakensTheOthersAsTheNetworkSays) {
  const double torn = 1.5e-6;
  const std::vector<double> pressures = FourCupsOneTorn(false, torn);
  const VacuumParameters vacuum = Lifter(4).vacuum;
  const auto drawn = [&](double p) { return kAmbient * SuctionFlow(vacuum.ejector, p - kAmbient); };
  const auto cup_at = [&](double manifold) {
    return FallingRoot(
        [&](double p) {
          return OrificeThroughput(torn, kAmbient, p) -
                 OrificeThroughput(vacuum.line.hose_area, p, manifold);
        },
        manifold, kAmbient);
  };
  const double manifold =
      FallingRoot([&](double p) { return OrificeThroughput(torn, kAmbient, cup_at(p)) - drawn(p); },
                  0.8 * kAmbient, kAmbient);
  const double expected = manifold - kAmbient;
  EXPECT_NEAR(pressures[0], expected, 5e-3 * std::abs(expected));
  EXPECT_NEAR(pressures[1], cup_at(manifold) - kAmbient, 5e-3 * std::abs(expected));
  for (std::size_t cup = 2; cup <= 4; ++cup) {
    EXPECT_NEAR(pressures[cup], expected, 5e-3 * std::abs(expected));  // nothing flows there
  }
  std::printf("one of four torn: torn %.0f Pa, others %.0f Pa (%.0f)\n", pressures[1], pressures[2],
              expected);
}

TEST(GasPayload, CheckValvesKeepTheOthersVacuum) {
  const std::vector<double> pressures = FourCupsOneTorn(true, 1.5e-6);
  EXPECT_GT(pressures[1], -8e3);
  for (std::size_t cup = 2; cup <= 4; ++cup) EXPECT_LT(pressures[cup], -11e3);
}

TEST(GasPayload, ABoxOnFourCupsIsHeldByThreeAndTipsWhenTheirVacuumGoes) {
  const double mass = 0.5;
  for (const double torn : {1e-6, 2e-4}) {
    GripWorld world({Table(0.5, Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -0.02))),
                     FreeBox({0.12, 0.12, 0.02}, mass, 0.5, {0.0, 0.0, -0.01})},
                    kAbovePlate, Lifter(4));
    world.MoveTo(Lifted(-0.001), 0.02, 0.0);
    world.Wait(0.6, kSetpoint);
    world.MoveTo(Lifted(0.005), 0.05, kSetpoint);
    world.Wait(0.4, kSetpoint);
    const double weight = mass * kGravity;
    EXPECT_NEAR(world.object(1).force_W.z(), weight, 5e-3 * weight);
    world.simulator().SetFaults(FirstCupTorn(torn));
    world.Wait(torn < 1e-5 ? 0.5 : 0.25, kSetpoint);
    const Eigen::Vector3d up = world.object(1).X_WO.linear().col(2);
    const double height = world.object(1).X_WO.translation().z();
    std::printf("torn %.0e m^2: box at %.2f mm, tilted %.3f deg, cups %.0f and %.0f Pa, %s\n", torn,
                1e3 * height, std::acos(std::min(up.z(), 1.0)) * 180.0 / M_PI,
                world.result().cups[0].gauge_pressure, world.result().cups[3].gauge_pressure,
                NameOf(world.result().status));
    if (torn < 1e-5) {
      EXPECT_NEAR(world.object(1).force_W.z(), weight, 5e-3 * weight);
      EXPECT_LT(world.object(1).torque_W.norm(), 5e-3 * weight * 0.03);
      EXPECT_GT(height, 0.0);
      // The torn cup pulls less: its corner, at x < 0 and y > 0 in the world, hangs lower.
      EXPECT_GT(up.dot(Eigen::Vector3d(-1.0, 1.0, 0.0)), 1e-4);
    } else {
      EXPECT_LT(up.z(), std::cos(3.0 * M_PI / 180.0));  // on its way down, that corner first
      EXPECT_GT(up.dot(Eigen::Vector3d(-1.0, 1.0, 0.0)), 0.05);
      EXPECT_NE(world.result().status, SealStatus::kSealed);
    }
    EXPECT_EQ(world.undone_steps, 0);
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
