#include "vacuum_gripper_sim/core/contact.h"

#include <gtest/gtest.h>

#include <limits>

namespace vacuum_gripper_sim {
namespace {

/// A sheet of 1 mm with its top at z = 0, and a sphere of 10 mm that touches it from above at x
/// = 1.
std::vector<RigidSurface> SheetAndSphere() {
  RigidSurface sheet{"sheet", Box{{10.0, 10.0, 0.001}}};
  sheet.X_FS.translation().z() = -0.0005;
  RigidSurface sphere{"sphere", Sphere{0.01}};
  sphere.X_FS.translation() = Eigen::Vector3d(1.0, 0.0, 0.01);
  return {sheet, sphere};
}

TEST(NearestDistances, IsThatOfTheNearestSurface) {
  Eigen::Matrix3Xd x(3, 2);
  x << 0.0, 1.0, 0.0, 0.0, 0.003, 0.025;
  const std::vector<double> nearest = NearestDistances(SheetAndSphere(), {0, 1}, x);
  EXPECT_NEAR(nearest[0], 0.003, 1e-15);
  EXPECT_NEAR(nearest[1], 0.005, 1e-15);
  EXPECT_EQ(NearestDistances({}, {0}, x)[0], std::numeric_limits<double>::infinity());
}

// A node that a motion carries through a sheet and out below has passed it: its gap is measured on
// the side where it started, and its normal pushes it back there.
TEST(NarrowPhase, SeesANodePassThroughAThinSheet) {
  const std::vector<RigidSurface> surfaces = SheetAndSphere();
  Eigen::Matrix3Xd x0(3, 3);
  x0 << 0.0, 0.1, 0.2, 0.0, 0.0, 0.0, 2e-4, 2e-4, 0.5;
  Eigen::Matrix3Xd x1 = x0;
  x1(2, 0) = -0.003;
  NarrowPhase narrow_phase;
  narrow_phase.Begin(surfaces, {0, 1, 2}, x0);

  const std::vector<NodeContact> reaching =
      narrow_phase.Select(x1, [](const NodeContact& contact) { return contact.gap < 0.0; });
  ASSERT_EQ(reaching.size(), 1U);
  EXPECT_EQ(reaching[0].node, 0);
  EXPECT_EQ(reaching[0].surface, 0);
  EXPECT_NEAR(reaching[0].gap, -0.003, 1e-15);
  EXPECT_LT((reaching[0].normal - Eigen::Vector3d::UnitZ()).norm(), 1e-15);

  const std::vector<NodeContact> near = narrow_phase.Select(
      x1, [](const NodeContact& contact) { return contact.surface == 0 && contact.gap < 5e-4; });
  ASSERT_EQ(near.size(), 2U);
  EXPECT_EQ(near[1].node, 1);
  EXPECT_NEAR(near[1].gap, 2e-4, 1e-15);

  EXPECT_NEAR(narrow_phase.Ahead(0, x1).gap, -0.003, 1e-15);
}

}  // namespace
}  // namespace vacuum_gripper_sim
