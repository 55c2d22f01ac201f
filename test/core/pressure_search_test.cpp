#include "vacuum_gripper_sim/core/pressure_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace vacuum_gripper_sim {
namespace {

/// Tries until |f(p) - p| is at most 1 Pa. @returns how many evaluations that took; 99: too many.
int Evaluations(const std::function<double(double)>& f, double p, double slope = -1.0) {
  PressureSearch search(slope);
  for (int n = 1; n < 99; ++n) {
    const double air = f(p);
    if (std::abs(air - p) <= 1.0) return n;
    p = search.Next(p, air);
  }
  return 99;
}

TEST(PressureSearch, TakesThePressureOfAirThatDoesNotAskTheCup) {
  EXPECT_EQ(Evaluations([](double) { return -6000.0; }, 0.0), 2);
}

TEST(PressureSearch, FindsTheRootOfALineInThreeEvaluationsAndInTwoWhenItsSlopeIsKnown) {
  for (const double slope : {-0.2, -0.7, -1.5, -8.0, -60.0}) {
    const auto f = [&](double p) { return p + slope * (p + 6000.0); };
    EXPECT_LE(Evaluations(f, -5500.0), 3) << slope;
    EXPECT_EQ(Evaluations(f, -5500.0, slope), 2) << slope;
  }
}

TEST(PressureSearch, RemembersTheSlopeItMeasured) {
  PressureSearch search(-1.0);
  const auto f = [](double p) { return p - 4.0 * (p + 6000.0); };
  const double next = search.Next(-5500.0, f(-5500.0));
  search.Next(next, f(next));
  EXPECT_NEAR(search.slope(), -4.0, 1e-12);
}

TEST(PressureSearch, StaysWithinItsBracketAtAKink) {
  // A lip that opens at -3 kPa and lets air in: hardly any slope on one side, a steep one beyond.
  const auto f = [](double p) { return p > -3000.0 ? -7000.0 : -7000.0 - 40.0 * (p + 3000.0); };
  EXPECT_LE(Evaluations(f, 0.0), 15);
  // A jump has no root: what is tried comes as near to it as one likes.
  PressureSearch search;
  double p = 0.0;
  for (int i = 0; i < 30; ++i) p = search.Next(p, p > -3000.0 ? -7000.0 : 0.0);
  EXPECT_NEAR(p, -3000.0, 1e-3);
}

TEST(PressureSearch, IsNotLedAstrayByARisingPiece) {
  // Of a floating lip: more vacuum brings more volume. The only root is beyond.
  const auto f = [](double p) { return p > -100.0 ? 1.5 * p - 10.0 : -160.0 - 3.0 * (p + 100.0); };
  EXPECT_LE(Evaluations(f, 0.0), 12);
}

}  // namespace
}  // namespace vacuum_gripper_sim
