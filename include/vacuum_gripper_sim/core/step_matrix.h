#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vacuum_gripper_sim/core/crew.h"
#include "vacuum_gripper_sim/core/elastic_body.h"
#include "vacuum_gripper_sim/core/element_pack.h"
#include "vacuum_gripper_sim/core/node_matrix.h"

namespace vacuum_gripper_sim {

/// All that A = mass_factor M + stiffness_factor K depends on at one state.
struct Linearization {
  std::vector<Pack> tangents;    ///< Of all elements, see TangentsBegin().
  double stiffness_factor{0.0};  ///< [s^2]
  double mass_factor{0.0};       ///< [-]
};

/** Assembles A of the free nodes. What depends on the mesh alone is found once; different threads
 may assemble at the same time.

 Elements are assembled in a few parts of neighbours, each into blocks of its own, so that threads
 can share the work without sharing memory. Between parts, places repeat. */
class StepMatrix {
 public:
  /// @param body Must outlive this. @param free_row First of a node's three rows; -1: clamped.
  StepMatrix(const ElasticBody& body, const std::vector<int>& free_row);

  /// The sparsity, with values of zero.
  const NodeMatrix& pattern() const { return pattern_; }
  /// @param[in,out] A A copy of pattern(); its values are replaced. [kg]
  /// @param crew Shares the work; none: the calling thread alone. The same values either way.
  void Assemble(const Linearization& linearization, NodeMatrix* A, Crew* crew = nullptr) const;

 private:
  /// A block of an element's matrix that A has a place for.
  struct ElementBlock {
    std::uint8_t a{0}, b{0};  ///< Nodes of the element, of row and column.
    int place{0};             ///< In A.
  };
  struct Mass {
    int node{0};
    int place{0};  ///< Of its diagonal block.
  };
  /// Ranges of elements, blocks_, masses_ and of A's places.
  struct Part {
    std::size_t elements_begin{0}, elements_end{0};
    std::size_t blocks_begin{0};
    std::size_t masses_begin{0}, masses_end{0};
    std::ptrdiff_t places_begin{0}, places_end{0};
  };

  template <typename Element>
  void FindParts(const std::vector<Element>& elements, const std::vector<int>& free_row);
  void AssemblePart(const Part& part, const Linearization& linearization, NodeMatrix* A) const;

  const ElasticBody* body_;
  NodeMatrix pattern_;
  std::vector<Part> parts_;
  std::vector<ElementBlock> blocks_;     // element by element
  std::vector<std::size_t> blocks_end_;  // of each
  std::vector<Mass> masses_;
};

}  // namespace vacuum_gripper_sim
