#include "vacuum_gripper_sim/config/timeline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

std::vector<Keyframe> Read(const std::string& yaml) { return ReadTimeline(YAML::Load(yaml), "t"); }

TEST(Timeline, InterpolatesPositionLinearly) {
  const auto timeline = Read(
      "[{time: 0, position: [0, 0, 0.02]}, {time: 2, position: [0.04, 0, 0.01]},"
      " {time: 3, position: [0.04, 0, 0.01]}]");
  // A quarter of the way: x = .01, z = .0175.
  EXPECT_TRUE(CommandAt(timeline, 0.5)
                  .X_WM.translation()
                  .isApprox(Eigen::Vector3d(0.01, 0.0, 0.0175), 1e-14));
  EXPECT_EQ(CommandAt(timeline, 0.0).X_WM.translation(), Eigen::Vector3d(0.0, 0.0, 0.02));
  EXPECT_EQ(CommandAt(timeline, 2.0).X_WM.translation(), Eigen::Vector3d(0.04, 0.0, 0.01));
  EXPECT_EQ(CommandAt(timeline, 2.7).X_WM.translation(), Eigen::Vector3d(0.04, 0.0, 0.01));
  EXPECT_EQ(CommandAt(timeline, 99.0).X_WM.translation(), Eigen::Vector3d(0.04, 0.0, 0.01));
  EXPECT_EQ(CommandAt(timeline, -1.0).X_WM.translation(), Eigen::Vector3d(0.0, 0.0, 0.02));
}

TEST(Timeline, PointsDownByDefault) {
  const auto timeline = Read("[{time: 0, position: [0, 0, 0]}, {time: 1, position: [0, 0, 0]}]");
  const Eigen::Matrix3d R = CommandAt(timeline, 0.3).X_WM.linear();
  EXPECT_TRUE(R.col(2).isApprox(-Eigen::Vector3d::UnitZ(), 1e-14));
  EXPECT_TRUE(R.col(0).isApprox(Eigen::Vector3d::UnitX(), 1e-14));
}

TEST(Timeline, TurnsAtConstantSpeed) {
  // From none to 90 degrees of yaw; a third of the time is 30 degrees.
  const auto timeline = Read(
      "[{time: 0, position: [0, 0, 0], rotation: [0, 0, 0]},"
      " {time: 3, position: [0, 0, 0], rotation: [0, 0, 0.70710678118, 0.70710678118]}]");
  const Eigen::Vector3d x = CommandAt(timeline, 1.0).X_WM.linear().col(0);
  EXPECT_NEAR(x.x(), std::sqrt(3.0) / 2.0, 1e-10);
  EXPECT_NEAR(x.y(), 0.5, 1e-10);
}

TEST(Timeline, SmoothWaysBeginAndEndAtRest) {
  const auto timeline = Read(
      "[{time: 0, position: [0, 0, 0]}, {time: 2, position: [1, 0, 0], smooth: true},"
      " {time: 3, position: [2, 0, 0]}]");
  const auto x = [&](double time) { return PoseAt(timeline, time).translation().x(); };
  EXPECT_NEAR(x(0.5), 0.15625, 1e-14);  // f = 1/4: 3/16 - 2/64
  EXPECT_NEAR(x(1.0), 0.5, 1e-14);
  EXPECT_NEAR(x(1e-3) / 1e-3, 0.0, 1e-3);                // at rest at first
  EXPECT_NEAR((1.0 - x(2.0 - 1e-3)) / 1e-3, 0.0, 1e-3);  // and at last
  EXPECT_NEAR(x(2.25), 1.25, 1e-14);                     // the next way is straight
}

TEST(Timeline, ObjectsAreNotTurnedAndHaveNoSetpoint) {
  const auto motion = ReadMotion(
      YAML::Load("[{time: 0, position: [0, 0, 1]}, {time: 1, position: [0, 0, 2]}]"), "m");
  EXPECT_TRUE(PoseAt(motion, 0.5).linear().isIdentity(1e-14));
  EXPECT_EQ(PoseAt(motion, 0.5).translation(), Eigen::Vector3d(0.0, 0.0, 1.5));
  EXPECT_TRUE(Contains(ErrorOf([] {
                         ReadMotion(YAML::Load("[{time: 0, position: [0, 0, 1]}, {time: 1, "
                                               "position: [0, 0, 2], pressure_setpoint: 0}]"),
                                    "m");
                       }),
                       "m.1.pressure_setpoint is not a known key"));
  EXPECT_TRUE(Contains(ErrorOf([] { ReadMotion(YAML::Load("[]"), "m"); }), "m = []"));
}

TEST(Timeline, SetpointHoldsUntilAnother) {
  const auto timeline = Read(
      "[{time: 0, position: [0, 0, 0]}, {time: 1, position: [0, 0, 0], pressure_setpoint: -6000},"
      " {time: 2, position: [0, 0, 0]}, {time: 3, position: [0, 0, 0], pressure_setpoint: 0}]");
  EXPECT_EQ(CommandAt(timeline, 0.99).pressure_setpoint, 0.0);
  EXPECT_EQ(CommandAt(timeline, 1.0).pressure_setpoint, -6000.0);
  EXPECT_EQ(CommandAt(timeline, 2.5).pressure_setpoint, -6000.0);
  EXPECT_EQ(CommandAt(timeline, 3.0).pressure_setpoint, 0.0);
}

TEST(Timeline, RoundedStepTimesReachTheirKeyframe) {
  const auto timeline = Read(
      "[{time: 0, position: [0, 0, 0]}, {time: 0.3, position: [0, 0, 0], pressure_setpoint: -1},"
      " {time: 1, position: [0, 0, 0]}]");
  const double h = 0.1;
  EXPECT_EQ(CommandAt(timeline, h * 3).pressure_setpoint, -1.0);
  EXPECT_EQ(CommandAt(timeline, 0.3 - 1e-12).pressure_setpoint, -1.0);
  EXPECT_EQ(CommandAt(timeline, 0.2).pressure_setpoint, 0.0);
}

TEST(Timeline, RefusalsNameTheKeyframe) {
  const auto error = [](const std::string& yaml) { return ErrorOf([&] { Read(yaml); }); };
  EXPECT_TRUE(Contains(error("[{time: 0, position: [0, 0, 0]}]"), "at least 2 keyframes"));
  EXPECT_TRUE(Contains(error("5"), "t = 5"));
  EXPECT_TRUE(Contains(error("[{time: 0.5, position: [0, 0, 0]}, {time: 1, position: [0, 0, 0]}]"),
                       "t.0.time = 0.5; expected 0"));
  EXPECT_TRUE(Contains(error("[{time: 0, position: [0, 0, 0]}, {time: 2, position: [0, 0, 0]},"
                             " {time: 2, position: [0, 0, 0]}]"),
                       "t.2.time = 2; expected more than"));
  EXPECT_TRUE(Contains(error("[{time: 0, position: [0, 0, 0]}, {time: 1, position: [0, .nan, 0]}]"),
                       "t.1.position.1 = .nan; expected a finite number"));
  EXPECT_TRUE(
      Contains(error("[{time: 0, position: [0, 0, 0]}, {time: 1}]"), "t.1.position is not set"));
  EXPECT_TRUE(Contains(error("[{time: 0, position: [0, 0, 0], speed: 1}, {time: 1}]"),
                       "t.0.speed is not a known key"));
}

}  // namespace
}  // namespace vacuum_gripper_sim
