#include "vacuum_gripper_sim/core/element_pack.h"

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

template <typename Element>
void ElementPack<Element>::Gather(const Eigen::Matrix3Xd& values, NodalVectors* gathered) const {
  for (std::size_t a = 0; a < Element::kNodes; ++a) {
    for (int lane = 0; lane < kPackLanes; ++lane) {
      const double* const value = values.col(nodes[a][static_cast<std::size_t>(lane)]).data();
      for (std::size_t i = 0; i < 3; ++i) (*gathered)[a][i](lane) = value[i];
    }
  }
}

template <typename Element>
PackMatrix3 ElementPack<Element>::Gradient(const NodalVectors& values, std::size_t point) const {
  PackMatrix3 gradient;
  for (Pack& entry : gradient) entry.setZero();
  for (std::size_t a = 0; a < Element::kNodes; ++a) {
    const std::array<Pack, 3>& dN = gradients[point][a];
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 3; ++i) gradient[i + 3 * j] += values[a][i] * dN[j];
    }
  }
  return gradient;
}

template <typename Element>
void ElementPack<Element>::AddDivergence(const PackMatrix3& P, std::size_t point,
                                         NodalVectors* sum) const {
  PackMatrix3 weighted;
  for (std::size_t k = 0; k < 9; ++k) weighted[k] = weights[point] * P[k];
  for (std::size_t a = 0; a < Element::kNodes; ++a) {
    const std::array<Pack, 3>& dN = gradients[point][a];
    for (std::size_t i = 0; i < 3; ++i) {
      (*sum)[a][i] += weighted[i] * dN[0] + weighted[i + 3] * dN[1] + weighted[i + 6] * dN[2];
    }
  }
}

template <typename Element>
void ElementPack<Element>::AddTo(const NodalVectors& values, Eigen::Matrix3Xd* target) const {
  for (std::size_t a = 0; a < Element::kNodes; ++a) {
    for (int lane = 0; lane < kPackLanes; ++lane) {
      double* const sum = target->col(nodes[a][static_cast<std::size_t>(lane)]).data();
      for (std::size_t i = 0; i < 3; ++i) sum[i] += values[a][i](lane);
    }
  }
}

template <typename Element>
std::vector<ElementPack<Element>> MakeElementPacks(const std::vector<Element>& elements,
                                                   std::size_t begin, std::size_t end) {
  std::vector<ElementPack<Element>> packs;
  for (; begin < end; begin += kPackLanes) {
    ElementPack<Element>& pack = packs.emplace_back();
    for (int lane = 0; lane < kPackLanes; ++lane) {
      const std::size_t e = begin + static_cast<std::size_t>(lane);
      const Element& element = elements[std::min(e, end - 1)];
      for (std::size_t a = 0; a < Element::kNodes; ++a) {
        pack.nodes[a][static_cast<std::size_t>(lane)] = element.nodes[a];
      }
      for (std::size_t q = 0; q < Element::kPoints; ++q) {
        pack.weights[q](lane) = e < end ? element.weights[q] : 0.0;
        for (std::size_t a = 0; a < Element::kNodes; ++a) {
          for (std::size_t j = 0; j < 3; ++j) {
            pack.gradients[q][a][j](lane) =
                element.gradients[q](static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(a));
          }
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
  for (int lane = 0; lane < kPackLanes; ++lane) {
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

template struct ElementPack<LinearTetrahedron>;
template struct ElementPack<QuadraticTetrahedron>;
template std::vector<ElementPack<LinearTetrahedron>> MakeElementPacks(
    const std::vector<LinearTetrahedron>&, std::size_t, std::size_t);
template std::vector<ElementPack<QuadraticTetrahedron>> MakeElementPacks(
    const std::vector<QuadraticTetrahedron>&, std::size_t, std::size_t);

}  // namespace vacuum_gripper_sim
