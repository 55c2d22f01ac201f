#include "vacuum_gripper_sim/core/tetrahedron.h"

#include <cmath>

namespace vacuum_gripper_sim {
namespace {

/// dP = lambda (R : dF) R + mu (dF + R dF^T R) gives, with g_a = R dN_a/dX and M_ab the weighted
/// sum of g_a g_b^T,
///
///     K_ab = lambda M_ab + mu (M_ba + tr(M_ab) I).
template <typename Element>
void SetStiffness(const Element& element, const CorotationalLaw& law,
                  const PointTangents<Element, CorotationalLaw>& tangents,
                  typename Element::Stiffness* K) {
  constexpr int kLanes = Element::kLanes;
  Eigen::Matrix<double, 3 * kLanes, Element::kPoints> g;  // times the weight's root
  for (std::size_t q = 0; q < Element::kPoints; ++q) {
    Eigen::Map<typename Element::NodalVectors> g_q(g.col(static_cast<Eigen::Index>(q)).data());
    g_q.noalias() = (std::sqrt(element.weights[q]) * element.gradients[q])
                        .lazyProduct(tangents[q].R.transpose());
  }
  typename Element::Stiffness M;
  M.noalias() = g.lazyProduct(g.transpose());
  const auto part = [](auto& matrix, int i, int j) {
    return matrix.template block<kLanes, kLanes>(i * kLanes, j * kLanes);
  };
  const double lambda = law.lame().lambda;
  const double mu = law.lame().mu;
  const Eigen::Matrix<double, kLanes, kLanes> trace =
      mu * (part(M, 0, 0) + part(M, 1, 1) + part(M, 2, 2));
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      part(*K, i, j) = lambda * part(M, i, j) + mu * part(M, j, i);
      if (i == j) part(*K, i, j) += trace;
    }
  }
}

/// Any tangent: K_ab(i, k) is the sum over J, L of dN_a/dX_J tangent(iJ, kL) dN_b/dX_L.
template <typename Element>
void SetStiffness(const Element& element, const NeoHookeanLaw&,
                  const PointTangents<Element, NeoHookeanLaw>& tangents,
                  typename Element::Stiffness* K) {
  constexpr int kLanes = Element::kLanes;
  using Gradients =
      Eigen::Matrix<double, kLanes, 3 * Element::kPoints>;  // all points, side by side
  const Eigen::Map<const Gradients> G(element.gradients[0].data());
  Gradients T;  // tangent(iJ, kL) dN_b/dX_L of all points, a column each (point, J)
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i <= k; ++i) {
      for (std::size_t q = 0; q < Element::kPoints; ++q) {
        for (int J = 0; J < 3; ++J) {
          const Eigen::Vector3d row(tangents[q](i + 3 * J, k), tangents[q](i + 3 * J, k + 3),
                                    tangents[q](i + 3 * J, k + 6));
          T.col(3 * static_cast<int>(q) + J).noalias() =
              element.gradients[q].lazyProduct(element.weights[q] * row);
        }
      }
      auto block = K->template block<kLanes, kLanes>(i * kLanes, k * kLanes);
      block.noalias() = G.lazyProduct(T.transpose());
      if (i < k) K->template block<kLanes, kLanes>(k * kLanes, i * kLanes) = block.transpose();
    }
  }
}

}  // namespace

template <int N, int Q, typename Law>
void ElementForces(const Tetrahedron<N, Q>& element, const Law& law,
                   const typename Tetrahedron<N, Q>::NodalVectors& x,
                   typename Tetrahedron<N, Q>::NodalVectors* f,
                   typename Tetrahedron<N, Q>::Stiffness* K) {
  f->setZero();
  PointTangents<Tetrahedron<N, Q>, Law> tangents;
  for (std::size_t q = 0; q < Q; ++q) {
    Eigen::Matrix3d F;
    F.noalias() = x.transpose().lazyProduct(element.gradients[q]);
    const Eigen::Matrix3d P = law.Stress(F, K != nullptr ? &tangents[q] : nullptr);
    const Eigen::Matrix3d minus_weighted = -element.weights[q] * P.transpose();
    *f += element.gradients[q].lazyProduct(minus_weighted);
  }
  if (K != nullptr) SetStiffness(element, law, tangents, K);
}

template <int N, int Q, typename Law>
void ElementStiffness(const Tetrahedron<N, Q>& element, const Law& law,
                      const PointTangents<Tetrahedron<N, Q>, Law>& tangents,
                      typename Tetrahedron<N, Q>::Stiffness* K) {
  SetStiffness(element, law, tangents, K);
}

#define VACUUM_GRIPPER_INSTANTIATE(Element, Law)                                                 \
  template void ElementForces(const Element&, const Law&, const Element::NodalVectors&,          \
                              Element::NodalVectors*, Element::Stiffness*);                      \
  template void ElementStiffness(const Element&, const Law&, const PointTangents<Element, Law>&, \
                                 Element::Stiffness*)
VACUUM_GRIPPER_INSTANTIATE(LinearTetrahedron, CorotationalLaw);
VACUUM_GRIPPER_INSTANTIATE(LinearTetrahedron, NeoHookeanLaw);
VACUUM_GRIPPER_INSTANTIATE(QuadraticTetrahedron, CorotationalLaw);
VACUUM_GRIPPER_INSTANTIATE(QuadraticTetrahedron, NeoHookeanLaw);
#undef VACUUM_GRIPPER_INSTANTIATE

}  // namespace vacuum_gripper_sim
