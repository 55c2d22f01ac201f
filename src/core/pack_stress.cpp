#include "vacuum_gripper_sim/core/pack_stress.h"

#include <algorithm>
#include <cstddef>

#include "vacuum_gripper_sim/core/polar_decomposition.h"

namespace vacuum_gripper_sim {
namespace {

Eigen::Matrix3d Lane(const PackMatrix3& packs, int lane) {
  Eigen::Matrix3d matrix;
  for (std::size_t k = 0; k < 9; ++k) matrix.data()[k] = packs[k](lane);
  return matrix;
}

void SetLane(const Eigen::Matrix3d& matrix, int lane, PackMatrix3* packs) {
  for (std::size_t k = 0; k < 9; ++k) (*packs)[k](lane) = matrix.data()[k];
}

/// Column c of the cofactors: a x b of the two columns that follow.
void SetCofactors(const PackMatrix3& R, std::size_t c, PackMatrix3* cofactors) {
  const Pack* const a = &R[3 * ((c + 1) % 3)];
  const Pack* const b = &R[3 * ((c + 2) % 3)];
  (*cofactors)[3 * c] = a[1] * b[2] - a[2] * b[1];
  (*cofactors)[3 * c + 1] = a[2] * b[0] - a[0] * b[2];
  (*cofactors)[3 * c + 2] = a[0] * b[1] - a[1] * b[0];
}

/// RotationOf() lane by lane; what its Newton's iteration leaves to others is left to it.
PackMatrix3 RotationsOf(const PackMatrix3& F) {
  constexpr double kMinDeterminant = 0.05;
  constexpr double kSquaredChange = 1e-16;
  constexpr int kMaxIterations = 12;
  PackMatrix3 R = F;
  PackMatrix3 cofactors;
  Pack smallest = Pack::Constant(1.0);  // determinant so far
  Pack change;
  for (int i = 0; i < kMaxIterations; ++i) {
    for (std::size_t c = 0; c < 3; ++c) SetCofactors(R, c, &cofactors);
    const Pack determinant = R[0] * cofactors[0] + R[1] * cofactors[1] + R[2] * cofactors[2];
    smallest = smallest.min(determinant);
    const Pack factor = 0.5 / determinant;
    change.setZero();
    for (std::size_t k = 0; k < 9; ++k) {
      const Pack next = 0.5 * R[k] + factor * cofactors[k];
      change += (next - R[k]).square();
      R[k] = next;
    }
    if (change.maxCoeff() < kSquaredChange) break;
  }
  for (int lane = 0; lane < kPackLanes; ++lane) {
    if (smallest(lane) > kMinDeterminant && change(lane) < kSquaredChange) continue;
    SetLane(RotationOf(Lane(F, lane)), lane, &R);
  }
  return R;
}

}  // namespace

PackMatrix3 Stress(const CorotationalLaw& law, const PackMatrix3& F, Pack* tangent) {
  const PackMatrix3 R = RotationsOf(F);
  std::copy(R.begin(), R.end(), tangent);
  Pack trace = Pack::Constant(-3.0);
  for (std::size_t k = 0; k < 9; ++k) trace += R[k] * F[k];
  const Pack pressure = law.lame().lambda * trace;
  PackMatrix3 P;
  for (std::size_t k = 0; k < 9; ++k) {
    P[k] = 2.0 * law.lame().mu * (F[k] - R[k]) + pressure * R[k];
  }
  return P;
}

PackMatrix3 Stress(const NeoHookeanLaw& law, const PackMatrix3& F, Pack* tangent) {
  PackMatrix3 P;
  for (int lane = 0; lane < kPackLanes; ++lane) {
    NeoHookeanLaw::Tangent tangent_at;
    SetLane(law.Stress(Lane(F, lane), &tangent_at), lane, &P);
    for (int k = 0; k < tangent_at.size(); ++k) tangent[k](lane) = tangent_at.data()[k];
  }
  return P;
}

/// R (lambda tr(E) I + mu (E + E^T)) with E = R^T dF.
PackMatrix3 StressChange(const CorotationalLaw& law, const Pack* tangent, const PackMatrix3& dF) {
  const Pack* const R = tangent;
  PackMatrix3 E;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      E[i + 3 * j] =
          R[3 * i] * dF[3 * j] + R[3 * i + 1] * dF[3 * j + 1] + R[3 * i + 2] * dF[3 * j + 2];
    }
  }
  const double mu = law.lame().mu;
  const Pack pressure = law.lame().lambda * (E[0] + E[4] + E[8]);
  PackMatrix3 S;  // of dP = R S
  for (std::size_t i = 0; i < 3; ++i) S[4 * i] = 2.0 * mu * E[4 * i] + pressure;
  S[1] = S[3] = mu * (E[1] + E[3]);
  S[2] = S[6] = mu * (E[2] + E[6]);
  S[5] = S[7] = mu * (E[5] + E[7]);
  PackMatrix3 dP;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      dP[i + 3 * j] = R[i] * S[3 * j] + R[i + 3] * S[3 * j + 1] + R[i + 6] * S[3 * j + 2];
    }
  }
  return dP;
}

PackMatrix3 StressChange(const NeoHookeanLaw&, const Pack* tangent, const PackMatrix3& dF) {
  PackMatrix3 dP;
  for (Pack& entry : dP) entry.setZero();
  for (std::size_t column = 0; column < 9; ++column) {
    for (std::size_t k = 0; k < 9; ++k) dP[k] += tangent[k + 9 * column] * dF[column];
  }
  return dP;
}

CorotationalLaw::Tangent TangentAt(const CorotationalLaw&, const Pack* tangent, int lane) {
  CorotationalLaw::Tangent at;
  for (int k = 0; k < at.R.size(); ++k) at.R.data()[k] = tangent[k](lane);
  return at;
}

NeoHookeanLaw::Tangent TangentAt(const NeoHookeanLaw&, const Pack* tangent, int lane) {
  NeoHookeanLaw::Tangent at;
  for (int k = 0; k < at.size(); ++k) at.data()[k] = tangent[k](lane);
  return at;
}

}  // namespace vacuum_gripper_sim
