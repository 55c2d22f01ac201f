#include "vacuum_gripper_sim/core/elimination_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "support/block_mesh.h"

namespace vacuum_gripper_sim {
namespace {

/// Nodes that share an element are neighbours.
NodeGraph BlockGraph(int cells, bool quadratic) {
  const TetMesh mesh = MakeBlock(cells, cells, 2 * cells, {0.02, 0.02, 0.04}, quadratic);
  std::vector<std::set<int>> neighbours(static_cast<std::size_t>(mesh.nodes.cols()));
  for (Eigen::Index e = 0; e < mesh.elements.cols(); ++e) {
    for (Eigen::Index i = 0; i < mesh.elements.rows(); ++i) {
      for (Eigen::Index j = 0; j < mesh.elements.rows(); ++j) {
        if (i == j) continue;
        neighbours[static_cast<std::size_t>(mesh.elements(i, e))].insert(mesh.elements(j, e));
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

/// The same graph, its nodes numbered otherwise.
NodeGraph Renumbered(const NodeGraph& graph, const std::vector<int>& number) {
  NodeGraph renumbered(graph.size());
  for (std::size_t a = 0; a < graph.size(); ++a) {
    std::vector<int>& neighbours = renumbered[static_cast<std::size_t>(number[a])];
    for (const int b : graph[a]) neighbours.push_back(number[static_cast<std::size_t>(b)]);
    std::sort(neighbours.begin(), neighbours.end());
  }
  return renumbered;
}

bool IsPermutation(std::vector<int> nodes, std::size_t size) {
  std::sort(nodes.begin(), nodes.end());
  return nodes == Numbers(size);
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
  EXPECT_TRUE(IsPermutation(order.node_at, graph.size()));
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

// As it is numbered, layer after layer, the block is a band.
TEST(EliminationOrder, IsFarCheaperThanABand) {
  // Leaves first: two entries in each of their columns, and one for the centre.
  EXPECT_EQ(CountOperations(Star(6), FindEliminationOrder(Star(6))), 5 * 4 + 1);

  const NodeGraph graph = BlockGraph(7, false);
  const auto operations = [&](const std::vector<int>& nodes) {
    EXPECT_TRUE(IsPermutation(nodes, graph.size()));
    return CountOperations(graph, Postordered(graph, nodes));
  };
  const double band = operations(Numbers(graph.size()));
  const double found = CountOperations(graph, FindEliminationOrder(graph));
  EXPECT_LT(found, 0.3 * band);
  EXPECT_LE(found, operations(MinimumDegreeOrder(graph, Numbers(graph.size()))));
  for (const int seed : {1, 2, 3}) {
    const std::vector<int> dissected = NestedDissectionOrder(graph, seed);
    if (dissected.empty()) continue;  // built without METIS
    EXPECT_LT(operations(dissected), 0.5 * band);
    EXPECT_LE(found, operations(dissected));
  }
}

// Where the numbers that the nodes have are bad ones, others are found.
TEST(EliminationOrder, DoesNotDependOnTheNodesNumbers) {
  const NodeGraph graph = BlockGraph(7, false);
  std::vector<int> number = Numbers(graph.size()), worst;
  double most = 0.0;
  std::mt19937 random(1);
  for (int i = 0; i < 6; ++i) {
    std::shuffle(number.begin(), number.end(), random);
    const double operations =
        CountOperations(graph, Postordered(graph, MinimumDegreeOrder(graph, number)));
    if (operations < most) continue;
    most = operations;
    worst = number;
  }
  const NodeGraph renumbered = Renumbered(graph, worst);
  const std::vector<int> as_numbered = MinimumDegreeOrder(renumbered, Numbers(renumbered.size()));
  EXPECT_EQ(CountOperations(renumbered, Postordered(renumbered, as_numbered)), most);
  EXPECT_LT(CountOperations(renumbered, FindEliminationOrder(renumbered)), 0.97 * most);
}

TEST(EliminationOrder, IsTheSameEveryTime) {
  const NodeGraph graph = BlockGraph(4, true), other = BlockGraph(2, true);
  const EliminationOrder first = FindEliminationOrder(graph);
  FindEliminationOrder(other);  // which is the last one now
  EXPECT_EQ(FindEliminationOrder(graph).node_at, first.node_at);
  EXPECT_EQ(NestedDissectionOrder(graph, 1), NestedDissectionOrder(graph, 1));
}

TEST(EliminationOrder, HandlesGraphsWithoutEdges) {
  EXPECT_TRUE(FindEliminationOrder({}).node_at.empty());
  const EliminationOrder order = FindEliminationOrder(NodeGraph(3));
  EXPECT_EQ(order.parent, (std::vector<int>{-1, -1, -1}));
  EXPECT_EQ(CountOperations(NodeGraph(3), order), 3.0);
}

TEST(EliminationOrder, HandlesASingleElement) {
  const NodeGraph graph{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
  EXPECT_EQ(CountOperations(graph, FindEliminationOrder(graph)), 16 + 9 + 4 + 1);
}

extern "C" void DoNothing(int, siginfo_t*, void*) {}

// METIS has handlers of its own.
TEST(EliminationOrder, LeavesTheHostsSignalsAlone) {
  struct sigaction own = {};
  struct sigaction found = {};
  struct sigaction before = {};
  own.sa_sigaction = DoNothing;
  own.sa_flags = SA_SIGINFO;
  ASSERT_EQ(sigaction(SIGTERM, &own, &before), 0);
  NestedDissectionOrder(BlockGraph(3, false), 1);
  ASSERT_EQ(sigaction(SIGTERM, &before, &found), 0);
  EXPECT_EQ(found.sa_sigaction, DoNothing);
  EXPECT_NE(found.sa_flags & SA_SIGINFO, 0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
