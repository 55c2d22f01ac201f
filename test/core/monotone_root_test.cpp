#include "monotone_root.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vacuum_gripper_sim {
namespace {

TEST(MonotoneRoot, FindsRootsOfSmoothSteepAndKinkedFunctions) {
  EXPECT_NEAR(MonotoneRoot([](double x) { return x * x * x - 2.0; }, 0.0, 5.0, 0.0), std::cbrt(2.0),
              1e-14);
  EXPECT_NEAR(MonotoneRoot([](double x) { return std::cbrt(x - 0.3); }, 0.0, 1e6, 0.0), 0.3, 1e-14);
  EXPECT_NEAR(MonotoneRoot([](double x) { return std::tanh(1e6 * (x - 0.7)) + 1e-3 * (x - 0.7); },
                           0.0, 1.0, 0.0),
              0.7, 1e-14);
  EXPECT_NEAR(MonotoneRoot([](double x) { return x < 2.0 ? 1e-6 * (x - 2.0) : 1e6 * (x - 2.0); },
                           -1e3, 1e3, 0.0),
              2.0, 1e-12);
}

TEST(MonotoneRoot, TakesAnEndThatIsTheRoot) {
  const auto identity = [](double x) { return x; };
  EXPECT_EQ(MonotoneRoot(identity, 0.0, 7.0, 0.0), 0.0);
  EXPECT_EQ(MonotoneRoot(identity, -7.0, 0.0, 0.0), 0.0);
}

TEST(MonotoneRoot, NeedsFewEvaluations) {
  int evaluations = 0;
  MonotoneRoot(
      [&](double x) {
        ++evaluations;
        return std::exp(x) - 3.0;
      },
      0.0, 4.0, 1e-9);
  EXPECT_LE(evaluations, 15);  // 33 by bisection
}

}  // namespace
}  // namespace vacuum_gripper_sim
