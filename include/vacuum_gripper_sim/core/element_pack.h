#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/material_model.h"
#include "vacuum_gripper_sim/core/tetrahedron.h"

namespace vacuum_gripper_sim {

/// Elements worked on side by side, a lane each: as many as fill a vector register, four at least.
constexpr int kPackLanes =
    std::max(4, EIGEN_MAX_STATIC_ALIGN_BYTES / static_cast<int>(sizeof(double)));
/// A quantity of each of them.
using Pack = Eigen::Array<double, kPackLanes, 1>;
/// Entry (i, j) at i + 3 j.
using PackMatrix3 = std::array<Pack, 9>;
/// Elements are visited in so many parts of neighbours: work for that many threads. The step matrix
/// of 700 linear elements gets a quarter more places by it.
constexpr std::size_t kElementParts = 4;

/** Some elements side by side, so that the loop over elements runs in vector registers. One that
 is not full repeats its last element with weight zero. */
template <typename Element>
struct ElementPack {
  /// Component i at node a: [a][i].
  using NodalVectors = std::array<std::array<Pack, 3>, Element::kNodes>;

  std::array<std::array<int, kPackLanes>, Element::kNodes> nodes;  ///< Whose columns are theirs.
  std::array<NodalVectors, Element::kPoints> gradients;            ///< dN_a/dX. [1/m]
  std::array<Pack, Element::kPoints> weights;                      ///< Rest volume. [m^3]

  /// @param values 3 by #nodes.
  void Gather(const Eigen::Matrix3Xd& values, NodalVectors* gathered) const;
  /// Of a field given at the nodes, by the rest position, at a point.
  PackMatrix3 Gradient(const NodalVectors& values, std::size_t point) const;
  /// sum_a += weight P dN_a/dX at a point.
  void AddDivergence(const PackMatrix3& P, std::size_t point, NodalVectors* sum) const;
  /// target += values. @param[in,out] target 3 by #nodes.
  void AddTo(const NodalVectors& values, Eigen::Matrix3Xd* target) const;
};

/// @param begin,end Elements [begin, end).
template <typename Element>
std::vector<ElementPack<Element>> MakeElementPacks(const std::vector<Element>& elements,
                                                   std::size_t begin, std::size_t end);

/// How many packs hold what a law keeps of its tangent at a point.
constexpr int TangentSize(const CorotationalLaw&) { return 9; }  // the rotation
constexpr int TangentSize(const NeoHookeanLaw&) { return 81; }

/// Where the tangents of a pack begin among those of all, which are stored pack by pack, point by
/// point.
template <typename Element, typename Law>
std::size_t TangentsBegin(std::size_t pack, const Law& law) {
  return pack * Element::kPoints * static_cast<std::size_t>(TangentSize(law));
}

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
