#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/pack.h"
#include "vacuum_gripper_sim/core/pack_stress.h"
#include "vacuum_gripper_sim/core/tetrahedron.h"

namespace vacuum_gripper_sim {

/// Elements are visited in so many parts of neighbours: work for that many threads. The step matrix
/// of 700 linear elements gets a quarter more places by it.
constexpr std::size_t kElementParts = 4;

/** Some elements side by side, so that the loop over elements runs in vector registers. One that
 is not full repeats its last element with weight zero.

 Gradients go by way of the barycentric coordinates L1 .. L3: those of the shape functions are the
 same in all elements, so that an element only has to know dL/dX. */
template <typename Element>
struct ElementPack {
  using NodalVectors = std::array<PackVector3, Element::kNodes>;
  using PointMatrices = std::array<PackMatrix3, Element::kPoints>;

  std::array<std::array<int, kPackLanes>, Element::kNodes> nodes;  ///< Whose columns are theirs.
  PointMatrices dL_dX;                         ///< Of L1 .. L3, a row each. [1/m]
  std::array<Pack, Element::kPoints> weights;  ///< Rest volume. [m^3]

  /// @param values 3 by #nodes.
  void Gather(const Eigen::Matrix3Xd& values, NodalVectors* gathered) const;
  /// Of a field given at the nodes, by the rest position, at all points.
  void Gradients(const NodalVectors& values, PointMatrices* gradients) const;
  /// Node a gets factor times the sum over points of weight P dN_a/dX.
  void Divergence(const PointMatrices& P, double factor, NodalVectors* divergence) const;
  /// target += values. @param[in,out] target 3 by #nodes.
  void AddTo(const NodalVectors& values, Eigen::Matrix3Xd* target) const;
};

/// @param begin,end Elements [begin, end).
template <typename Element>
std::vector<ElementPack<Element>> MakeElementPacks(const std::vector<Element>& elements,
                                                   std::size_t begin, std::size_t end);

/// Where the tangents of a pack begin among those of all, which are stored pack by pack, point by
/// point.
template <typename Element, typename Law>
std::size_t TangentsBegin(std::size_t pack, const Law& law) {
  return pack * Element::kPoints * static_cast<std::size_t>(TangentSize(law));
}

}  // namespace vacuum_gripper_sim
