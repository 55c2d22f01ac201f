#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vacuum_gripper_sim/core/elastic_body.h"
#include "vacuum_gripper_sim/core/node_matrix.h"
#include "vacuum_gripper_sim/core/point_pack.h"

namespace vacuum_gripper_sim {

/// All that A = mass_factor M + stiffness_factor K depends on at one state.
struct Linearization {
  std::vector<Pack> tangents;    ///< Four points after the other, element by element.
  double stiffness_factor{0.0};  ///< [s^2]
  double mass_factor{0.0};       ///< [-]
};

/** Assembles A of the free nodes. What depends on the mesh alone is found once; different threads
 may assemble at the same time. */
class StepMatrix {
 public:
  /// @param body Must outlive this. @param free_row First of a node's three rows; -1: clamped.
  StepMatrix(const ElasticBody& body, const std::vector<int>& free_row);

  /// The sparsity, with values of zero.
  const NodeMatrix& pattern() const { return pattern_; }
  /// @param[in,out] A A copy of pattern(); its values are replaced. [kg]
  void Assemble(const Linearization& linearization, NodeMatrix* A) const;

 private:
  /// A block of an element's matrix that A has a place for.
  struct Share {
    std::uint8_t a{0}, b{0};  ///< Nodes of the element, of row and column.
    int place{0};             ///< In A.
  };

  template <typename Element, typename Law>
  void AddElements(const std::vector<Element>& elements, const Law& law,
                   const Linearization& linearization, NodeMatrix* A) const;

  const ElasticBody* body_;
  NodeMatrix pattern_;
  std::vector<Share> shares_;            // element by element
  std::vector<std::size_t> shares_end_;  // by element
  std::vector<int> mass_nodes_;          // the free nodes
  std::vector<int> diagonal_;            // place of each of these
};

}  // namespace vacuum_gripper_sim
