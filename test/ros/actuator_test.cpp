#include "actuator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

constexpr double kTimeStep = 0.01;
const MotionLimits kLimits{1.0, 6.0, 0.1};  // [m/s], [rad/s]: 10 mm and 0.06 rad a step; [s]

Eigen::Isometry3d At(double x, double angle = 0.0) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation().x() = x;
  X.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return X;
}

double AngleOf(const Eigen::Isometry3d& X) { return Eigen::AngleAxisd(X.linear()).angle(); }

TEST(Actuator, IsWhereItIsToldWithinItsLimits) {
  Actuator actuator(At(0.0), kLimits, kTimeStep);
  const Eigen::Isometry3d target = At(0.0099, 0.059);
  actuator.SetTarget(target);
  EXPECT_TRUE(actuator.NextPose().matrix() == target.matrix());  // to the last bit
}

TEST(Actuator, GoesFarNoFasterThanItMay) {
  Actuator actuator(At(0.0), kLimits, kTimeStep);
  actuator.SetTarget(At(0.025));
  for (const double x : {0.010, 0.020, 0.025, 0.025}) {
    const Eigen::Isometry3d pose = actuator.NextPose();
    EXPECT_NEAR(pose.translation().x(), x, 1e-15);
    actuator.OnStep(pose, false);
  }
  EXPECT_FALSE(actuator.IsBehind(0.0));
}

// A turn of 0.12 rad takes two steps, so 4 mm on the way take two steps as well.
TEST(Actuator, TurnsAndMovesTogether) {
  Actuator actuator(At(0.0), kLimits, kTimeStep);
  actuator.SetTarget(At(0.004, 0.12));
  EXPECT_NEAR(actuator.NextPose().translation().x(), 0.002, 1e-12);
  EXPECT_NEAR(AngleOf(actuator.NextPose()), 0.06, 1e-12);
}

TEST(Actuator, HalvesItsStrideWhileStepsAreUndone) {
  Actuator actuator(At(0.0), kLimits, kTimeStep);
  actuator.SetTarget(At(0.008));
  for (const double x : {0.008, 0.004, 0.002}) {
    EXPECT_NEAR(actuator.NextPose().translation().x(), x, 1e-15);
    actuator.OnStep(At(0.0), true);  // stayed where it was
  }
  EXPECT_NEAR(actuator.NextPose().translation().x(), 0.001, 1e-15);
  actuator.OnStep(At(0.001), false);
  EXPECT_NEAR(actuator.NextPose().translation().x(), 0.001 + 0.25 * 0.007, 1e-15);
}

TEST(Actuator, JumpsOnReset) {
  Actuator actuator(At(0.0), kLimits, kTimeStep);
  actuator.SetTarget(At(3.0, 1.0));
  actuator.JumpToTarget();
  EXPECT_TRUE(actuator.NextPose().matrix() == At(3.0, 1.0).matrix());
}

/// In the midst of a motion, right after a target that is 5 mm and .05 rad away.
Actuator OnItsWay() {
  Actuator actuator(At(0.0), kLimits, kTimeStep);
  for (int i = 0; i < 5; ++i) {
    if (i == 0) actuator.SetTarget(At(0.0));
    actuator.OnStep(actuator.NextPose(), false);
  }
  actuator.SetTarget(At(0.005, 0.05));
  return actuator;
}

TEST(Actuator, TurnsEvenlyToo) {
  const Actuator actuator = OnItsWay();
  EXPECT_NEAR(actuator.NextPose().translation().x(), 0.005 / 7.5, 1e-12);
  EXPECT_NEAR(AngleOf(actuator.NextPose()), 0.05 / 7.5, 1e-9);
}

TEST(Actuator, HalvesItsStrideOnItsWayToo) {
  Actuator actuator = OnItsWay();
  actuator.OnStep(At(0.0), true);
  EXPECT_NEAR(actuator.NextPose().translation().x(), 0.5 * 0.005 / 7.5, 1e-12);
}

TEST(Actuator, TakesTheLastOfSeveralTargetsInAStep) {
  Actuator actuator = OnItsWay();
  actuator.SetTarget(At(0.006));
  EXPECT_NEAR(actuator.NextPose().translation().x(), 0.006 / 7.5, 1e-12);
}

TEST(Actuator, JumpsOnItsWayToo) {
  Actuator actuator = OnItsWay();
  actuator.JumpToTarget();
  EXPECT_TRUE(actuator.NextPose().matrix() == At(0.005, 0.05).matrix());
}

constexpr double kStride = 0.1 * kTimeStep;  // [m]

/// Targets on a motion at 0.1 m/s along x, so many steps apart. @returns where the mount is after
/// every step. [m]
std::vector<double> Follow(const std::vector<int>& steps_between, const MotionLimits& limits) {
  Actuator actuator(At(0.0), limits, kTimeStep);
  std::vector<double> places;
  for (const int steps : steps_between) {
    actuator.SetTarget(At(kStride * static_cast<double>(places.size())));
    for (int i = 0; i < steps; ++i) {
      const Eigen::Isometry3d pose = actuator.NextPose();
      actuator.OnStep(pose, false);
      places.push_back(pose.translation().x());
    }
  }
  return places;
}

/// The fastest and the slowest step from `begin` on. [m/s]
std::pair<double, double> Speeds(const std::vector<double>& places, std::size_t begin) {
  std::vector<double> speeds;
  for (std::size_t i = begin; i < places.size(); ++i) {
    speeds.push_back((places[i] - places[i - 1]) / kTimeStep);
  }
  const auto [slowest, fastest] = std::minmax_element(speeds.begin(), speeds.end());
  return {*slowest, *fastest};
}

TEST(Actuator, MakesAnEvenMotionOfTargetsRarerThanSteps) {
  const std::vector<double> places = Follow(std::vector<int>(30, 5), kLimits);
  const auto [slowest, fastest] = Speeds(places, 100);
  EXPECT_NEAR(slowest, 0.1, 1e-6);
  EXPECT_NEAR(fastest, 0.1, 1e-6);
  EXPECT_NEAR(places.back(), kStride * (150 - 1.5 * 5), 1e-7);  // one and a half periods behind
}

TEST(Actuator, StaysOnItsWayWhenTargetsComeUnevenly) {
  std::vector<int> steps_between;
  for (int i = 0; i < 40; ++i) steps_between.push_back(i % 3 == 0 ? 6 : i % 3 == 1 ? 4 : 5);
  const auto [slowest, fastest] = Speeds(Follow(steps_between, kLimits), 50);
  EXPECT_GT(slowest, 0.08);  // 0 and 0.6 without
  EXPECT_LT(fastest, 0.12);
}

// As rare as they may be, and now and then later than that.
TEST(Actuator, StaysOnItsWayWhenATargetIsLate) {
  std::vector<int> steps_between;
  for (int i = 0; i < 40; ++i) steps_between.push_back(i % 4 == 3 ? 12 : 9 + i % 3);
  const auto [slowest, fastest] = Speeds(Follow(steps_between, kLimits), 100);
  EXPECT_GT(slowest, 0.07);
  EXPECT_LT(fastest, 0.13);
}

// Four targets in five steps: no step rests.
TEST(Actuator, StaysOnItsWayWhenTargetsAreLittleRarerThanSteps) {
  std::vector<int> steps_between;
  for (int i = 0; i < 80; ++i) steps_between.push_back(i % 4 == 0 ? 2 : 1);
  const auto [slowest, fastest] = Speeds(Follow(steps_between, kLimits), 40);
  EXPECT_GT(slowest, 0.04);
  EXPECT_LT(fastest, 0.16);
}

TEST(Actuator, GoesAtOnceToTargetsThatAreNoMotion) {
  MotionLimits limits = kLimits;
  const std::vector<double> rare = Follow(std::vector<int>(5, 12), limits);  // .12 s apart
  EXPECT_NEAR(rare[13], kStride * 12, 1e-15);
  const std::vector<double> frequent = Follow(std::vector<int>(5, 1), limits);
  EXPECT_NEAR(frequent[4], kStride * 4, 1e-15);
  limits.longest_command_period = 0.0;
  EXPECT_NEAR(Follow(std::vector<int>(5, 5), limits)[10], kStride * 10, 1e-15);
}

TEST(Actuator, ReachesTheEndOfAMotion) {
  Actuator actuator(At(0.0), kLimits, kTimeStep);
  for (int i = 1; i <= 25; ++i) {
    if (i % 5 == 0) actuator.SetTarget(At(0.001 * i));
    actuator.OnStep(actuator.NextPose(), false);
  }
  for (int i = 0; i < 7; ++i) actuator.OnStep(actuator.NextPose(), false);
  EXPECT_EQ(actuator.NextPose().translation().x(), 0.025);
}

// A fast motion's target may be far without the mount being late.
TEST(Actuator, IsBehindOnlyWhereItsLimitsKeepIt) {
  for (const double speed : {0.9, 1.5}) {  // it may go at 1 m/s
    Actuator actuator(At(0.0), kLimits, kTimeStep);
    for (int i = 1; i <= 100; ++i) {
      if (i % 5 == 0) actuator.SetTarget(At(speed * kTimeStep * i));
      actuator.OnStep(actuator.NextPose(), false);
    }
    EXPECT_EQ(actuator.IsBehind(0.01), speed > 1.0);
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
