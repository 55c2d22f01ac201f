#include "vacuum_gripper_sim/core/polar_decomposition.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace vacuum_gripper_sim {
namespace {

Eigen::Matrix3d SomeRotation() {
  return Eigen::AngleAxisd(1.9, Eigen::Vector3d(1.0, 0.2, -0.7).normalized()).matrix();
}

// F = R S with a symmetric positive S: the rotation comes back exactly.
TEST(RotationOf, SplitsRotationAndStretch) {
  Eigen::Matrix3d S;
  S << 1.3, 0.2, -0.1, 0.2, 0.7, 0.05, -0.1, 0.05, 1.1;
  EXPECT_LT((RotationOf(SomeRotation() * S) - SomeRotation()).norm(), 1e-13);
}

// Flat, collapsed and inverted F still give a rotation, never a reflection.
TEST(RotationOf, IsARotationForSingularAndInvertedInput) {
  for (const double stretch : {0.04, 1e-9, 0.0, -1e-9, -0.3, -2.0}) {
    const Eigen::Matrix3d F =
        SomeRotation() * Eigen::Vector3d(1.2, 0.9, stretch).asDiagonal() * SomeRotation();
    const Eigen::Matrix3d R = RotationOf(F);
    EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-12) << stretch;
    EXPECT_NEAR(R.determinant(), 1.0, 1e-12) << stretch;
  }
  EXPECT_NEAR(RotationOf(Eigen::Matrix3d::Zero()).determinant(), 1.0, 1e-12);
}

// An element pushed slightly through itself turns round its flattest direction: R is that of the
// element before it was inverted.
TEST(RotationOf, InvertsThroughTheFlattestDirection) {
  const Eigen::Matrix3d F = SomeRotation() * Eigen::Vector3d(1.1, 1.0, -0.2).asDiagonal();
  EXPECT_LT((RotationOf(F) - SomeRotation()).norm(), 1e-12);
}

}  // namespace
}  // namespace vacuum_gripper_sim
