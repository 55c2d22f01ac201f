#pragma once

#include <vector>

namespace vacuum_gripper_sim {

/// Neighbours of every node, itself excluded, ascending.
using NodeGraph = std::vector<std::vector<int>>;

/// In which order a factorisation eliminates the nodes of a graph.
struct EliminationOrder {
  std::vector<int> node_at;   ///< The k-th node; children before their parents.
  std::vector<int> position;  ///< The inverse.
  std::vector<int> parent;    ///< Elimination tree, by position; -1: a root.
};

/** The best order found: the one whose factorisation takes the fewest operations among

 - approximate minimum degree ([Amestoy 1996], by Eigen), begun from a few numberings of the nodes,
   for among nodes of the same degree their numbers decide, and what they decide costs up to a third
   more or less,
 - nested dissection ([Karypis 1998], by METIS, where the library was built with it), best from a
   few thousand nodes on.

 The same graph gets the same order in every run.

 [Amestoy 1996] P. R. Amestoy, T. A. Davis, I. S. Duff, "An approximate minimum degree ordering
 algorithm", SIAM J. Matrix Anal. Appl. 17(4). [Karypis 1998] G. Karypis, V. Kumar, "A fast and
 high quality multilevel scheme for partitioning irregular graphs", SIAM J. Sci. Comput. 20(1). */
EliminationOrder FindEliminationOrder(const NodeGraph& graph);

/// The tree of a given order, made postorder. @param node_at A permutation of the nodes.
EliminationOrder Postordered(const NodeGraph& graph, const std::vector<int>& node_at);

/// Sum over the columns of L of the square of their number of entries, one a node: what a
/// factorisation takes, but for a factor.
double CountOperations(const NodeGraph& graph, const EliminationOrder& order);

}  // namespace vacuum_gripper_sim
