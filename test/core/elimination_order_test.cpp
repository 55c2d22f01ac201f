#include "vacuum_gripper_sim/core/elimination_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "support/block_mesh.h"

namespace vacuum_gripper_sim {
namespace {

/// Nodes that share an element are neighbours.
NodeGraph BlockGraph(int cells, bool quadratic) {
  const TetMesh mesh = MakeBlock(cells, cells, 2 * cells, {0.02, 0.02, 0.04}, quadratic);
  std::vector<std::set<int>> neighbours(static_cast<std::size_t>(mesh.nodes.cols()));
  for (Eigen::Index e = 0; e < mesh.elements.cols(); ++e) {
    for (const int a : mesh.elements.col(e)) {
      for (const int b : mesh.elements.col(e)) {
        if (a != b) neighbours[static_cast<std::size_t>(a)].insert(b);
      }
    }
  }
  NodeGraph graph;
  for (const auto& of_node : neighbours) graph.emplace_back(of_node.begin(), of_node.end());
  return graph;
}

/// Every node a neighbour of node 0 and of no other.
NodeGraph Star(int size) {
  NodeGraph graph(static_cast<std::size_t>(size), {0});
  graph[0].resize(static_cast<std::size_t>(size) - 1);
  std::iota(graph[0].begin(), graph[0].end(), 1);
  return graph;
}

std::vector<int> Numbers(std::size_t size) {
  std::vector<int> numbers(size);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// Plays the elimination: a node's remaining neighbours become neighbours of each other.
double PlayElimination(const NodeGraph& graph, const std::vector<int>& node_at) {
  std::vector<std::set<int>> left;
  for (const auto& neighbours : graph) left.emplace_back(neighbours.begin(), neighbours.end());
  double operations = 0.0;
  for (const int node : node_at) {
    const std::set<int> neighbours = left[static_cast<std::size_t>(node)];
    const double num_entries = 1.0 + static_cast<double>(neighbours.size());
    operations += num_entries * num_entries;
    for (const int a : neighbours) {
      left[static_cast<std::size_t>(a)].erase(node);
      for (const int b : neighbours) {
        if (a != b) left[static_cast<std::size_t>(a)].insert(b);
      }
    }
  }
  return operations;
}

TEST(EliminationOrder, CountsWhatEliminatingTakes) {
  for (const bool quadratic : {false, true}) {
    const NodeGraph graph = BlockGraph(2, quadratic);
    const EliminationOrder as_numbered = Postordered(graph, Numbers(graph.size()));
    const EliminationOrder best = FindEliminationOrder(graph);
    for (const EliminationOrder& order : {as_numbered, best}) {
      EXPECT_EQ(CountOperations(graph, order), PlayElimination(graph, order.node_at));
    }
    // Postorder changes the order, not what it takes.
    EXPECT_EQ(CountOperations(graph, as_numbered), PlayElimination(graph, Numbers(graph.size())));
  }
}

TEST(EliminationOrder, IsAPostorderOfItsTree) {
  const NodeGraph graph = BlockGraph(3, true);
  const EliminationOrder order = FindEliminationOrder(graph);
  std::vector<int> sorted = order.node_at;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted, Numbers(graph.size()));
  // What is below a node comes right before it.
  std::vector<int> first = Numbers(graph.size()), num_below(graph.size(), 0);
  for (std::size_t k = 0; k < graph.size(); ++k) {
    EXPECT_EQ(order.position[static_cast<std::size_t>(order.node_at[k])], static_cast<int>(k));
    EXPECT_EQ(static_cast<int>(k) - first[k], num_below[k]);
    if (order.parent[k] < 0) continue;
    ASSERT_GT(order.parent[k], static_cast<int>(k));
    const auto above = static_cast<std::size_t>(order.parent[k]);
    first[above] = std::min(first[above], first[k]);
    num_below[above] += 1 + num_below[k];
  }
}

TEST(EliminationOrder, TakesFewOperations) {
  // Leaves first: two entries in each of their columns, and one for the centre.
  EXPECT_EQ(CountOperations(Star(6), FindEliminationOrder(Star(6))), 5 * 4 + 1);
  // The block as it is numbered: a band. The worst of the orders tried takes a third of it.
  const NodeGraph graph = BlockGraph(6, false);
  const double band = CountOperations(graph, Postordered(graph, Numbers(graph.size())));
  EXPECT_LT(CountOperations(graph, FindEliminationOrder(graph)), 0.3 * band);
}

TEST(EliminationOrder, IsTheSameEveryTime) {
  const NodeGraph graph = BlockGraph(4, true);
  EXPECT_EQ(FindEliminationOrder(graph).node_at, FindEliminationOrder(graph).node_at);
}

TEST(EliminationOrder, HandlesGraphsWithoutEdges) {
  EXPECT_TRUE(FindEliminationOrder({}).node_at.empty());
  const EliminationOrder order = FindEliminationOrder(NodeGraph(3));
  EXPECT_EQ(order.parent, (std::vector<int>{-1, -1, -1}));
  EXPECT_EQ(CountOperations(NodeGraph(3), order), 3.0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
