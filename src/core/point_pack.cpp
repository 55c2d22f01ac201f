#include "vacuum_gripper_sim/core/point_pack.h"

#include <algorithm>
#include <cstddef>

#include "vacuum_gripper_sim/core/polar_decomposition.h"

namespace vacuum_gripper_sim {
namespace {

constexpr int kLanes = Pack::SizeAtCompileTime;

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
  for (int lane = 0; lane < kLanes; ++lane) {
    if (smallest(lane) > kMinDeterminant && change(lane) < kSquaredChange) continue;
    SetLane(RotationOf(Lane(F, lane)), lane, &R);
  }
  return R;
}

}  // namespace

template <typename Element>
PackMatrix3 PointPack<Element>::Gradient(const Eigen::Matrix3Xd& values) const {
  PackMatrix3 gradient;
  for (Pack& entry : gradient) entry.setZero();
  for (std::size_t a = 0; a < Element::kNodes; ++a) {
    for (int i = 0; i < 3; ++i) {
      Pack value;
      if constexpr (kElements == 1) {
        value.setConstant(values(i, nodes[0][a]));
      } else {
        for (std::size_t e = 0; e < kElements; ++e) {
          value(static_cast<int>(e)) = values(i, nodes[e][a]);
        }
      }
      for (std::size_t j = 0; j < 3; ++j) {
        gradient[static_cast<std::size_t>(i) + 3 * j] += value * gradients[a][j];
      }
    }
  }
  return gradient;
}

template <typename Element>
void PointPack<Element>::AddDivergence(const PackMatrix3& P, Eigen::Matrix3Xd* target) const {
  PackMatrix3 weighted;
  for (std::size_t k = 0; k < 9; ++k) weighted[k] = weights * P[k];
  for (std::size_t a = 0; a < Element::kNodes; ++a) {
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Pack sum = weighted[k] * gradients[a][0] + weighted[k + 3] * gradients[a][1] +
                       weighted[k + 6] * gradients[a][2];
      if constexpr (kElements == 1) {
        (*target)(i, nodes[0][a]) += sum.sum();
      } else {
        for (std::size_t e = 0; e < kElements; ++e) {
          (*target)(i, nodes[e][a]) += sum(static_cast<int>(e));
        }
      }
    }
  }
}

template <typename Element>
std::vector<PointPack<Element>> MakePointPacks(const std::vector<Element>& elements) {
  constexpr std::size_t kElements = PointPack<Element>::kElements;
  std::vector<PointPack<Element>> packs((elements.size() + kElements - 1) / kElements);
  for (std::size_t e = 0; e < kElements * packs.size(); ++e) {
    const Element& element = elements[std::min(e, elements.size() - 1)];
    PointPack<Element>& pack = packs[e / kElements];
    pack.nodes[e % kElements] = element.nodes;
    for (std::size_t q = 0; q < Element::kPoints; ++q) {
      const auto lane = static_cast<int>((e * Element::kPoints + q) % kLanes);
      pack.weights(lane) = e < elements.size() ? element.weights[q] : 0.0;
      for (int a = 0; a < Element::kNodes; ++a) {
        for (int j = 0; j < 3; ++j) {
          pack.gradients[static_cast<std::size_t>(a)][static_cast<std::size_t>(j)](lane) =
              element.gradients[q](j, a);
        }
      }
    }
  }
  return packs;
}

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
  for (int lane = 0; lane < kLanes; ++lane) {
    NeoHookeanLaw::Tangent tangent_at;
    SetLane(law.Stress(Lane(F, lane), &tangent_at), lane, &P);
    for (int k = 0; k < tangent_at.size(); ++k) tangent[k](lane) = tangent_at.data()[k];
  }
  return P;
}

PackMatrix3 StressChange(const CorotationalLaw& law, const Pack* tangent, const PackMatrix3& dF) {
  const Pack* const R = tangent;
  Pack trace = Pack::Zero();
  for (std::size_t k = 0; k < 9; ++k) trace += R[k] * dF[k];
  const Pack pressure = law.lame().lambda * trace;
  const double mu = law.lame().mu;
  PackMatrix3 dP;
  for (std::size_t j = 0; j < 3; ++j) {
    Pack column[3];  // of dF^T R
    for (std::size_t i = 0; i < 3; ++i) {
      column[i] =
          dF[3 * i] * R[3 * j] + dF[3 * i + 1] * R[3 * j + 1] + dF[3 * i + 2] * R[3 * j + 2];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = i + 3 * j;
      dP[k] = pressure * R[k] +
              mu * (dF[k] + R[i] * column[0] + R[i + 3] * column[1] + R[i + 6] * column[2]);
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

template struct PointPack<LinearTetrahedron>;
template struct PointPack<QuadraticTetrahedron>;
template std::vector<PointPack<LinearTetrahedron>> MakePointPacks(
    const std::vector<LinearTetrahedron>&);
template std::vector<PointPack<QuadraticTetrahedron>> MakePointPacks(
    const std::vector<QuadraticTetrahedron>&);

}  // namespace vacuum_gripper_sim
