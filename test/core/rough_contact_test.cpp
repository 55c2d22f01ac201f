#include "vacuum_gripper_sim/core/rough_contact.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vacuum_gripper_sim {
namespace {

constexpr double kModulus = 424e3;  // Pa
constexpr double kRough = 1e-5;     // m

// Well below E* and well above p_0 the bends at the ends of the range do not matter.
TEST(HydraulicGap, IsPerssonsSeparationWithPatirsAndChengsFlowFactor) {
  for (const double p : {0.02 * kModulus, 0.03 * kModulus, 0.05 * kModulus}) {
    const double u = kRough / rough_contact::kAlpha * std::log(rough_contact::kBeta * kModulus / p);
    const double g = u * std::cbrt(1.0 - 0.9 * std::exp(-0.56 * u / kRough));
    EXPECT_NEAR(HydraulicGap(kRough, p, kModulus), g, 0.06 * g) << p;
  }
}

TEST(HydraulicGap, IsThatOfTheHighestPeaksWithoutLoad) {
  const double u = rough_contact::kHighestPeak * kRough;
  EXPECT_NEAR(HydraulicGap(kRough, 0.0, kModulus),
              u * std::cbrt(1.0 - 0.9 * std::exp(-0.56 * u / kRough)), 1e-6 * u);
}

TEST(HydraulicGap, FallsSmoothlyWithThePressureAndStaysPositive) {
  double last = HydraulicGap(kRough, 0.0, kModulus);
  for (double p = 1.0; p < 100.0 * kModulus; p *= 1.05) {
    const double gap = HydraulicGap(kRough, p, kModulus);
    EXPECT_GT(gap, 0.0) << p;
    EXPECT_LT(gap, last) << p;
    EXPECT_GT(gap, 0.93 * last) << p;
    last = gap;
  }
}

TEST(HydraulicGap, IsInProportionToTheRoughness) {
  EXPECT_EQ(HydraulicGap(0.0, 1e4, kModulus), 0.0);
  EXPECT_NEAR(HydraulicGap(3e-5, 1e4, kModulus), 3.0 * HydraulicGap(1e-5, 1e4, kModulus), 1e-18);
  EXPECT_NEAR(HydraulicGap(1e-5, 1e4, kModulus), HydraulicGap(1e-5, 2e4, 2.0 * kModulus), 1e-18);
}

}  // namespace
}  // namespace vacuum_gripper_sim
