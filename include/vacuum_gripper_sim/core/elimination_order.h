#pragma once

#include <vector>

namespace vacuum_gripper_sim {

/// Neighbours of every node, itself excluded, ascending.
using NodeGraph = std::vector<std::vector<int>>;

/// In which order a factorisation eliminates the nodes of a graph: a postorder of its tree.
struct EliminationOrder {
  std::vector<int> node_at;   ///< The k-th node.
  std::vector<int> position;  ///< The inverse.
  std::vector<int> parent;    ///< Elimination tree, by position; -1: a root.
};

/** The cheapest order found, by CountOperations(), among

 - minimum degree, begun from a few numberings of the nodes: among nodes of the same degree their
   numbers decide, and what they decide costs up to a third more or less,
 - nested dissection from a few seeds, where the library was built with METIS.

 The same build gives a graph the same order in every run. Any thread may call it. */
EliminationOrder FindEliminationOrder(const NodeGraph& graph);

/** Approximate minimum degree, as Eigen has it ([Amestoy 1996]).
 @param number Of every node, a permutation: decides among nodes of the same degree.
 @returns the nodes in order.

 [Amestoy 1996] P. R. Amestoy, T. A. Davis, I. S. Duff, "An approximate minimum degree ordering
 algorithm", SIAM J. Matrix Anal. Appl. 17(4). */
std::vector<int> MinimumDegreeOrder(const NodeGraph& graph, const std::vector<int>& number);

/** Nested dissection by METIS ([Karypis 1998]). It uses the process's rand(): one thread at a time.
 @param seed Of its random choices.
 @returns the nodes in order; nothing where the library was built without METIS, where METIS fails,
   and for graphs without edges.

 [Karypis 1998] G. Karypis, V. Kumar, "A fast and high quality multilevel scheme for partitioning
 irregular graphs", SIAM J. Sci. Comput. 20(1). */
std::vector<int> NestedDissectionOrder(const NodeGraph& graph, int seed);

/// The tree of a given order, and the order as its postorder. @param nodes A permutation.
EliminationOrder Postordered(const NodeGraph& graph, const std::vector<int>& nodes);

/// Sum over the columns of L, one a node, of the square of their number of entries: what a
/// factorisation takes, but for a factor and for the zeros that merged fronts add.
double CountOperations(const NodeGraph& graph, const EliminationOrder& order);

}  // namespace vacuum_gripper_sim
