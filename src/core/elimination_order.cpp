#include "vacuum_gripper_sim/core/elimination_order.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstddef>
#include <mutex>
#include <numeric>
#include <random>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

/// Minimum degree is begun from the nodes' own numbers and from so many shuffled ones.
constexpr int kShuffles = 8;
/// Nested dissection from so many seeds.
constexpr int kSeeds = 3;

std::vector<int> Inverse(const std::vector<int>& order) {
  std::vector<int> position(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    position[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  }
  return position;
}

/// Not std::shuffle(), of which every standard library makes another.
void Shuffle(std::mt19937* random, std::vector<int>* numbers) {
  for (std::size_t i = numbers->size(); i > 1; --i) {
    std::swap((*numbers)[i - 1], (*numbers)[(*random)() % i]);
  }
}

/// Parent of each position in the elimination tree (Liu's algorithm with path compression).
std::vector<int> EliminationTree(const NodeGraph& graph, const std::vector<int>& node_at,
                                 const std::vector<int>& position) {
  std::vector<int> parent(graph.size(), -1);
  std::vector<int> ancestor(graph.size(), -1);
  for (int k = 0; k < static_cast<int>(graph.size()); ++k) {
    const int node = node_at[static_cast<std::size_t>(k)];
    for (const int neighbour : graph[static_cast<std::size_t>(node)]) {
      int i = position[static_cast<std::size_t>(neighbour)];
      while (i != -1 && i < k) {
        const int next = ancestor[static_cast<std::size_t>(i)];
        ancestor[static_cast<std::size_t>(i)] = k;
        if (next == -1) parent[static_cast<std::size_t>(i)] = k;
        i = next;
      }
    }
  }
  return parent;
}

/// Positions in depth-first order, children before parents.
std::vector<int> Postorder(const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<std::vector<int>> children(parent.size());
  std::vector<int> stack;
  for (int k = size - 1; k >= 0; --k) {
    const int above = parent[static_cast<std::size_t>(k)];
    if (above < 0) {
      stack.push_back(k);
    } else {
      children[static_cast<std::size_t>(above)].push_back(k);
    }
  }
  std::vector<int> order;
  while (!stack.empty()) {  // parents before children, then turned round
    const int k = stack.back();
    stack.pop_back();
    order.push_back(k);
    const auto& below = children[static_cast<std::size_t>(k)];
    stack.insert(stack.end(), below.begin(), below.end());
  }
  std::reverse(order.begin(), order.end());
  return order;
}

EliminationOrder FindCheapest(const NodeGraph& graph) {
  EliminationOrder cheapest;
  double fewest = 0.0;
  const auto consider = [&](const std::vector<int>& nodes) {
    EliminationOrder order = Postordered(graph, nodes);
    const double operations = CountOperations(graph, order);
    if (cheapest.node_at.empty() || operations < fewest) {
      cheapest = std::move(order);
      fewest = operations;
    }
  };
  std::vector<int> number(graph.size());
  std::iota(number.begin(), number.end(), 0);
  consider(MinimumDegreeOrder(graph, number));
  std::mt19937 random;
  for (int i = 0; i < kShuffles; ++i) {
    Shuffle(&random, &number);
    consider(MinimumDegreeOrder(graph, number));
  }
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<int> dissected = NestedDissectionOrder(graph, seed);
    if (!dissected.empty()) consider(dissected);
  }
  return cheapest;
}

}  // namespace

EliminationOrder FindEliminationOrder(const NodeGraph& graph) {
  // A process tends to simulate the same cup several times: the node on two threads, one of them
  // for the holding margin. Only one thread may be in METIS.
  static std::mutex mutex;
  static NodeGraph last_graph;
  static EliminationOrder last_order;
  const std::lock_guard<std::mutex> lock(mutex);
  if (graph != last_graph) {
    last_order = FindCheapest(graph);
    last_graph = graph;
  }
  return last_order;
}

std::vector<int> MinimumDegreeOrder(const NodeGraph& graph, const std::vector<int>& number) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t a = 0; a < graph.size(); ++a) {
    entries.emplace_back(number[a], number[a], 1.0);
    for (const int b : graph[a]) {
      entries.emplace_back(number[a], number[static_cast<std::size_t>(b)], 1.0);
    }
  }
  const auto size = static_cast<int>(graph.size());
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order_of_numbers;
  Eigen::AMDOrdering<int>()(pattern, order_of_numbers);

  const std::vector<int> node_of = Inverse(number);
  std::vector<int> nodes;
  nodes.reserve(graph.size());
  for (int k = 0; k < size; ++k) {
    nodes.push_back(node_of[static_cast<std::size_t>(order_of_numbers.indices()[k])]);
  }
  return nodes;
}

EliminationOrder Postordered(const NodeGraph& graph, const std::vector<int>& nodes) {
  const std::vector<int> postorder = Postorder(EliminationTree(graph, nodes, Inverse(nodes)));
  EliminationOrder order;
  for (const int k : postorder) order.node_at.push_back(nodes[static_cast<std::size_t>(k)]);
  order.position = Inverse(order.node_at);
  order.parent = EliminationTree(graph, order.node_at, order.position);
  return order;
}

double CountOperations(const NodeGraph& graph, const EliminationOrder& order) {
  // Row k of L reaches from each of its entries in A up the tree to k.
  std::vector<double> num_entries(graph.size(), 1.0);
  std::vector<int> last_row(graph.size(), -1);
  for (int k = 0; k < static_cast<int>(graph.size()); ++k) {
    last_row[static_cast<std::size_t>(k)] = k;
    const int node = order.node_at[static_cast<std::size_t>(k)];
    for (const int neighbour : graph[static_cast<std::size_t>(node)]) {
      auto i = static_cast<std::size_t>(order.position[static_cast<std::size_t>(neighbour)]);
      if (static_cast<int>(i) > k) continue;
      for (; last_row[i] != k; i = static_cast<std::size_t>(order.parent[i])) {
        last_row[i] = k;
        num_entries[i] += 1.0;
      }
    }
  }
  return std::inner_product(num_entries.begin(), num_entries.end(), num_entries.begin(), 0.0);
}

}  // namespace vacuum_gripper_sim
