#include "actuator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vacuum_gripper_sim {
namespace {

constexpr double kTimeStep = 0.01;
const MotionLimits kLimits{1.0, 6.0};  // [m/s], [rad/s]: 10 mm and 0.06 rad a step

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

}  // namespace
}  // namespace vacuum_gripper_sim
