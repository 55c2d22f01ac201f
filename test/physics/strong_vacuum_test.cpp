// Vacuum up to the strongest, pulled fast: the seal stays one seal, and whatever part of the cup
// reaches the surface stays above it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>

#include "physics/grip_cycle.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kA20Modulus = 338000.0;  // [Pa]
constexpr double kA30Modulus = 593000.0;  // [Pa]

GripCycle Sealed(double young_modulus, double pressure) {
  SimulatorParameters parameters = A20(0.01);
  parameters.material.young_modulus = young_modulus;
  GripCycle cycle(LoadBell("quadratic_700"), parameters);
  cycle.Drive(kCupLength - 0.001, 0.01, 0.0, 0.05);
  cycle.Drive(kCupLength - 0.001, 0.01, pressure, 0.3);
  return cycle;
}

/// Lowest point of the cup above the plane, every node counted. [m]
double LowestNode(const GripCycle& cycle) { return cycle.result().x_W.row(2).minCoeff(); }

class FastPull : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(FastPull, SealsOnceAndLosesOnce) {
  const auto [young_modulus, pressure] = GetParam();
  GripCycle cycle = Sealed(young_modulus, pressure);
  ASSERT_EQ(cycle.result().status, SealStatus::kSealed);
  double lowest = LowestNode(cycle);
  while (Holds(cycle.result()) && cycle.height() < kCupLength + 0.015) {
    cycle.Drive(cycle.height() + 0.0005, 0.05, pressure);
    lowest = std::min(lowest, LowestNode(cycle));
  }
  const double lift = cycle.height() - kCupLength;
  cycle.Drive(cycle.height() + 0.01, 0.05, pressure);
  EXPECT_EQ(cycle.result().status, SealStatus::kLost);
  EXPECT_EQ(cycle.seal_flips, 2);
  EXPECT_EQ(cycle.undone_steps, 0);
  EXPECT_LE(cycle.max_penetration, 1e-6);
  EXPECT_GE(lowest, -1e-6);
  std::printf("E = %.0f Pa at %.0f Pa, 50 mm/s: lost at %.1f mm\n", young_modulus, pressure,
              1e3 * lift);
}

INSTANTIATE_TEST_SUITE_P(Cups, FastPull,
                         testing::Combine(testing::Values(kA20Modulus, kA30Modulus),
                                          testing::Values(-1000.0, -8000.0, -15000.0)),
                         [](const auto& info) {
                           return (std::get<0>(info.param) == kA20Modulus ? "A20at" : "A30at") +
                                  std::to_string(std::lround(-std::get<1>(info.param))) + "Pa";
                         });

// The softer cup at its strongest vacuum may wrinkle; what it reports is finite and consistent.
TEST(StrongVacuum, ACupAtMinus20kPaStaysFiniteAndHonest) {
  GripCycle cycle = Sealed(kA20Modulus, -20000.0);
  for (int i = 0; i < 150; ++i) {
    cycle.Drive(cycle.height() + 0.0001, 0.01, -20000.0);
    const StepResult& result = cycle.result();
    ASSERT_TRUE(result.x_W.allFinite());
    ASSERT_TRUE(result.force_M.allFinite() && result.torque_M.allFinite());
    ASSERT_GE(LowestNode(cycle), -1e-6);
    ASSERT_EQ(Holds(result), result.gauge_pressure < 0.0);
  }
  EXPECT_LE(cycle.seal_flips, 2);
}

// Pressed far down under vacuum the ceiling of the dome lies on the surface: it is held there.
TEST(StrongVacuum, TheCeilingOfTheDomeTouchesAndDoesNotPass) {
  GripCycle cycle = Sealed(kA20Modulus, -6000.0);
  cycle.Drive(kCupLength - 0.011, 0.02, -6000.0, 0.2);
  const CavitySurface& cavity = cycle.simulator().cavity();
  const Eigen::Matrix3Xd& rest = cycle.simulator().mesh().nodes;
  double ceiling = 1.0;  // lowest point of the inner dome near the axis [m]
  for (const int node : cavity.nodes) {
    if (rest.col(node).head<2>().norm() > 0.006) continue;
    ceiling = std::min(ceiling, cycle.result().x_W(2, node));
  }
  EXPECT_LT(ceiling, 1e-6);
  EXPECT_GE(LowestNode(cycle), -1e-6);
  EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
  EXPECT_EQ(cycle.undone_steps, 0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
