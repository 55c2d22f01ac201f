#include "vacuum_gripper_sim/core/polar_decomposition.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace vacuum_gripper_sim {
namespace {

Eigen::Matrix3d RotationBySvd(const Eigen::Matrix3d& F) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if (U.determinant() * svd.matrixV().determinant() < 0.0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

}  // namespace

Eigen::Matrix3d RotationOf(const Eigen::Matrix3d& F) {
  // Below this determinant Newton's iteration is slow or runs to a reflection.
  constexpr double kMinDeterminant = 0.05;
  constexpr int kMaxIterations = 12;
  // The iteration converges quadratically: a change of 1e-8 leaves an error of 1e-16.
  constexpr double kSquaredChange = 1e-16;

  Eigen::Matrix3d R = F;
  for (int i = 0; i < kMaxIterations; ++i) {
    Eigen::Matrix3d cofactor;
    cofactor.col(0) = R.col(1).cross(R.col(2));
    cofactor.col(1) = R.col(2).cross(R.col(0));
    cofactor.col(2) = R.col(0).cross(R.col(1));
    const double determinant = R.col(0).dot(cofactor.col(0));
    if (!(determinant > kMinDeterminant)) break;
    const Eigen::Matrix3d next = 0.5 * (R + cofactor / determinant);
    const double change = (next - R).squaredNorm();
    R = next;
    if (change < kSquaredChange) return R;
  }
  return RotationBySvd(F);
}

}  // namespace vacuum_gripper_sim
