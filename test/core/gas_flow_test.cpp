#include "vacuum_gripper_sim/core/gas_flow.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vacuum_gripper_sim {
namespace {

constexpr double kArea = 1e-6;         // m^2
constexpr double kAmbient = 101325.0;  // Pa

TEST(OrificeThroughput, ChokesBelowTheCriticalRatio) {
  // Textbook: m' = .6847 A p / sqrt(R T) for gamma = 1.4, hence Q = m' R T.
  const double expected = 0.6847 * kArea * kAmbient * std::sqrt(287.06 * 293.15);
  EXPECT_NEAR(OrificeThroughput(kArea, kAmbient, 0.0), expected, 1e-4 * expected);
  EXPECT_EQ(OrificeThroughput(kArea, kAmbient, 0.0),
            OrificeThroughput(kArea, kAmbient, 0.52 * kAmbient));
  EXPECT_LT(OrificeThroughput(kArea, kAmbient, 0.6 * kAmbient),
            0.995 * OrificeThroughput(kArea, kAmbient, 0.0));
}

TEST(OrificeThroughput, IsBernoullisForSmallDifferences) {
  // Q = p A sqrt(2 dp / rho), of a density that hardly changes.
  const double drop = 0.005 * kAmbient;
  const double rho = kAmbient / (287.06 * 293.15);
  EXPECT_NEAR(OrificeThroughput(kArea, kAmbient, kAmbient - drop),
              kAmbient * kArea * std::sqrt(2.0 * drop / rho), 0.005 * kAmbient * kArea * 30.0);
}

TEST(OrificeThroughput, IsAntisymmetricContinuousAndZeroAtEqualPressures) {
  EXPECT_EQ(OrificeThroughput(kArea, kAmbient, kAmbient), 0.0);
  EXPECT_EQ(OrificeThroughput(kArea, 5e4, 8e4), -OrificeThroughput(kArea, 8e4, 5e4));
  EXPECT_EQ(OrificeThroughput(kArea, 0.0, 0.0), 0.0);
  for (double r = 0.0; r < 1.0; r += 1e-4) {
    const double change = OrificeThroughput(kArea, kAmbient, r * kAmbient) -
                          OrificeThroughput(kArea, kAmbient, (r + 1e-4) * kAmbient);
    EXPECT_GE(change, 0.0) << r;  // falls as the far side fills
    EXPECT_LT(change, 0.01 * OrificeThroughput(kArea, kAmbient, 0.0)) << r;
  }
}

TEST(SlitThroughput, IsPoiseuilles) {
  // A slit of 10 mm by 2 mm by 20 um: volume flow w g^3 dp / (12 mu l) at the mean pressure.
  const double shape = 10e-3 * std::pow(20e-6, 3) / 2e-3;
  const double p_1 = 1.0e5, p_2 = 0.9e5;
  const double volume_flow = 10e-3 * std::pow(20e-6, 3) * (p_1 - p_2) / (12.0 * 1.81e-5 * 2e-3);
  EXPECT_NEAR(SlitThroughput(shape, p_1, p_2), volume_flow * 0.95e5, 1e-12);
  EXPECT_EQ(SlitThroughput(shape, p_2, p_1), -SlitThroughput(shape, p_1, p_2));
}

}  // namespace
}  // namespace vacuum_gripper_sim
