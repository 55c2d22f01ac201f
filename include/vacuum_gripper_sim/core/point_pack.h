#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vacuum_gripper_sim/core/material_model.h"
#include "vacuum_gripper_sim/core/tetrahedron.h"

namespace vacuum_gripper_sim {

/// A quantity at four integration points, a lane each.
using Pack = Eigen::Array<double, 4, 1>;
/// Entry (i, j) at i + 3 j.
using PackMatrix3 = std::array<Pack, 9>;

/** Four integration points with their elements, one quadratic or four linear tetrahedra, so that
 the loop over elements runs in vector registers. A last pack of linear elements that is not full
 repeats its last element with weight zero. */
template <typename Element>
struct PointPack {
  static constexpr int kElements = 4 / Element::kPoints;

  std::array<std::array<int, Element::kNodes>, kElements> nodes;  ///< Mesh nodes.
  std::array<std::array<Pack, 3>, Element::kNodes> gradients;     ///< dN_a/dX. [1/m]
  Pack weights;                                                   ///< Rest volume. [m^3]

  /// Of a field given at the nodes, by the rest position. @param values 3 by #nodes.
  PackMatrix3 Gradient(const Eigen::Matrix3Xd& values) const;
  /// target_a += sum of P dN_a/dX over the points. @param[in,out] target 3 by #nodes.
  void AddDivergence(const PackMatrix3& P, Eigen::Matrix3Xd* target) const;
};

template <typename Element>
std::vector<PointPack<Element>> MakePointPacks(const std::vector<Element>& elements);

/// How many packs hold what a law keeps of its tangent at four points.
constexpr int TangentSize(const CorotationalLaw&) { return 9; }  // the rotation
constexpr int TangentSize(const NeoHookeanLaw&) { return 81; }

/// P at F. [Pa] @param[out] tangent TangentSize() packs.
PackMatrix3 Stress(const CorotationalLaw& law, const PackMatrix3& F, Pack* tangent);
PackMatrix3 Stress(const NeoHookeanLaw& law, const PackMatrix3& F, Pack* tangent);

/// dP of a dF. [Pa]
PackMatrix3 StressChange(const CorotationalLaw& law, const Pack* tangent, const PackMatrix3& dF);
PackMatrix3 StressChange(const NeoHookeanLaw& law, const Pack* tangent, const PackMatrix3& dF);

/// The tangent in one lane.
CorotationalLaw::Tangent TangentAt(const CorotationalLaw& law, const Pack* tangent, int lane);
NeoHookeanLaw::Tangent TangentAt(const NeoHookeanLaw& law, const Pack* tangent, int lane);

}  // namespace vacuum_gripper_sim
