#include "vacuum_gripper_sim/core/material_model.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "vacuum_gripper_sim/core/polar_decomposition.h"

namespace vacuum_gripper_sim {
namespace {

/// dJ/dF.
Eigen::Matrix3d Cofactors(const Eigen::Matrix3d& F) {
  Eigen::Matrix3d C;
  C.col(0) = F.col(1).cross(F.col(2));
  C.col(1) = F.col(2).cross(F.col(0));
  C.col(2) = F.col(0).cross(F.col(1));
  return C;
}

/// v x .
Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// tangent += factor (mode : .) mode.
void AddMode(double factor, const Eigen::Matrix3d& mode, Matrix9d* tangent) {
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> stacked(mode.data());
  tangent->noalias() += (factor * stacked) * stacked.transpose();
}

/// tangent -= dC, the derivative of the cofactors of S: linear in S.
void SubtractCofactorDerivative(const Eigen::Matrix3d& S, Matrix9d* tangent) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    const Eigen::Matrix3d cross = CrossMatrix(S.col(k));
    tangent->block<3, 3>(3 * i, 3 * j) += cross;
    tangent->block<3, 3>(3 * j, 3 * i) -= cross;
  }
}

/// Of a symmetric matrix, by its leading minors.
bool IsPositiveDefinite(const Eigen::Matrix3d& A) {
  return A(0, 0) > 0.0 && A(0, 0) * A(1, 1) - A(1, 0) * A(1, 0) > 0.0 && A.determinant() > 0.0;
}

}  // namespace

LameConstants Lame(const Material& material) {
  const double E = material.young_modulus;
  const double nu = material.poisson_ratio;
  return {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))};
}

double CorotationalLaw::EnergyDensity(const Eigen::Matrix3d& F) const {
  const Eigen::Matrix3d R = RotationOf(F);
  const double trace = R.cwiseProduct(F).sum() - 3.0;  // tr(R^T F - I)
  return lame_.mu * (F - R).squaredNorm() + 0.5 * lame_.lambda * trace * trace;
}

Eigen::Matrix3d CorotationalLaw::Stress(const Eigen::Matrix3d& F, Tangent* tangent) const {
  const Eigen::Matrix3d R = RotationOf(F);
  const double trace = R.cwiseProduct(F).sum() - 3.0;  // tr(R^T F - I)
  if (tangent != nullptr) tangent->R = R;
  return 2.0 * lame_.mu * (F - R) + lame_.lambda * trace * R;
}

double NeoHookeanLaw::EnergyDensity(const Eigen::Matrix3d& F) const {
  const double volume_change = F.determinant() - 1.0;
  return 0.5 * lame_.mu * (F.squaredNorm() - 3.0) - lame_.mu * volume_change +
         0.5 * (lame_.lambda + lame_.mu) * volume_change * volume_change;
}

Eigen::Matrix3d NeoHookeanLaw::Stress(const Eigen::Matrix3d& F, Tangent* tangent) const {
  const double mu = lame_.mu;
  const double kappa = lame_.lambda + lame_.mu;
  const Eigen::Matrix3d C = Cofactors(F);
  const double J = F.col(0).dot(C.col(0));
  const double p = mu - kappa * (J - 1.0);
  const Eigen::Matrix3d P = mu * F - p * C;
  if (tangent == nullptr) return P;

  // The exact tangent.
  *tangent = mu * Matrix9d::Identity();
  AddMode(kappa, C, tangent);
  SubtractCofactorDerivative(p * F, tangent);

  // The principal frame: F = R V diag(s) V^T, at most one s < 0.
  const Eigen::Matrix3d R = RotationOf(F);
  const Eigen::Matrix3d RtF = R.transpose() * F;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> stretch;
  stretch.computeDirect(0.5 * (RtF + RtF.transpose()));
  const Eigen::Vector3d s = stretch.eigenvalues();
  const Eigen::Matrix3d& V = stretch.eigenvectors();
  const Eigen::Vector3d t = p * s;

  // A mode with a negative eigenvalue, twice added, turns its sign. First the twists (i, j) - (j,
  // i) and flips (i, j) + (j, i) about axis k, whose squared norm is 2 here.
  for (int k = 0; k < 3; ++k) {
    const double eigenvalue = mu - std::abs(t(k));
    if (eigenvalue >= 0.0) continue;
    const Eigen::Vector3d v_i = V.col((k + 1) % 3);
    const Eigen::Vector3d v_j = V.col((k + 2) % 3);
    const double sign = t(k) > 0.0 ? -1.0 : 1.0;
    AddMode(-eigenvalue, R * (v_i * v_j.transpose() + sign * v_j * v_i.transpose()), tangent);
  }

  // Then those of the stretches.
  const Eigen::Vector3d c(s(1) * s(2), s(2) * s(0), s(0) * s(1));
  Eigen::Matrix3d A = kappa * c * c.transpose();
  for (int k = 0; k < 3; ++k) {
    A(k, k) += mu;
    A((k + 1) % 3, (k + 2) % 3) -= t(k);
    A((k + 2) % 3, (k + 1) % 3) -= t(k);
  }
  if (!IsPositiveDefinite(A)) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> stretches(A);
    for (int m = 0; m < 3; ++m) {
      const double eigenvalue = stretches.eigenvalues()(m);
      if (eigenvalue >= 0.0) break;
      const Eigen::Vector3d along = stretches.eigenvectors().col(m);
      AddMode(-2.0 * eigenvalue, R * V * along.asDiagonal() * V.transpose(), tangent);
    }
  }
  return P;
}

MaterialLaw MakeMaterialLaw(const Material& material) {
  const LameConstants lame = Lame(material);
  if (material.model == MaterialModel::kNeoHookean) return NeoHookeanLaw(lame);
  return CorotationalLaw(lame);
}

}  // namespace vacuum_gripper_sim
