#include "vacuum_gripper_sim/core/tetrahedron.h"

namespace vacuum_gripper_sim {

template <int N, int Q, typename Law>
void ElementForces(const Tetrahedron<N, Q>& element, const Law& law,
                   const typename Tetrahedron<N, Q>::NodalVectors& x,
                   typename Tetrahedron<N, Q>::NodalVectors* f,
                   PointTangents<Tetrahedron<N, Q>, Law>* tangents) {
  f->setZero();
  for (std::size_t q = 0; q < Q; ++q) {
    const Eigen::Matrix3d P =
        law.Stress(element.Gradient(x, q), tangents != nullptr ? &(*tangents)[q] : nullptr);
    f->template topRows<3>() -=
        element.weights[q] * P.lazyProduct(element.gradients[q].template topRows<3>());
  }
}

#define VACUUM_GRIPPER_INSTANTIATE(Element, Law)                                        \
  template void ElementForces(const Element&, const Law&, const Element::NodalVectors&, \
                              Element::NodalVectors*, PointTangents<Element, Law>*)
VACUUM_GRIPPER_INSTANTIATE(LinearTetrahedron, CorotationalLaw);
VACUUM_GRIPPER_INSTANTIATE(LinearTetrahedron, NeoHookeanLaw);
VACUUM_GRIPPER_INSTANTIATE(QuadraticTetrahedron, CorotationalLaw);
VACUUM_GRIPPER_INSTANTIATE(QuadraticTetrahedron, NeoHookeanLaw);
#undef VACUUM_GRIPPER_INSTANTIATE

}  // namespace vacuum_gripper_sim
