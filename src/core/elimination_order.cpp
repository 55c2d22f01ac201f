#include "vacuum_gripper_sim/core/elimination_order.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

#ifdef VACUUM_GRIPPER_METIS
#include <metis.h>
#endif

namespace vacuum_gripper_sim {
namespace {

/// Minimum degree is begun from the nodes' own numbers and from so many shuffled ones.
constexpr unsigned int kShuffles = 8;

std::vector<int> Inverse(const std::vector<int>& order) {
  std::vector<int> position(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    position[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  }
  return position;
}

/// @param number Of every node: decides among nodes of the same degree.
std::vector<int> MinimumDegree(const NodeGraph& graph, const std::vector<int>& number) {
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
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> numbers;
  Eigen::AMDOrdering<int>()(pattern, numbers);

  std::vector<int> node_at = Inverse(number);
  std::vector<int> order(graph.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    order[k] = node_at[static_cast<std::size_t>(numbers.indices()[static_cast<Eigen::Index>(k)])];
  }
  return order;
}

#ifdef VACUUM_GRIPPER_METIS
/// @returns nothing if METIS fails.
std::vector<int> NestedDissection(const NodeGraph& graph) {
  std::vector<idx_t> first{0}, neighbours;
  for (const std::vector<int>& of_node : graph) {
    neighbours.insert(neighbours.end(), of_node.begin(), of_node.end());
    first.push_back(static_cast<idx_t>(neighbours.size()));
  }
  if (neighbours.empty()) return {};
  auto size = static_cast<idx_t>(graph.size());
  std::vector<idx_t> node_at(graph.size()), position(graph.size());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;  // the same order in every run
  const int status = METIS_NodeND(&size, first.data(), neighbours.data(), nullptr, options,
                                  node_at.data(), position.data());
  if (status != METIS_OK) return {};
  return {node_at.begin(), node_at.end()};
}
#endif

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

}  // namespace

EliminationOrder FindEliminationOrder(const NodeGraph& graph) {
  EliminationOrder best;
  double fewest = 0.0;
  const auto consider = [&](const std::vector<int>& node_at) {
    if (node_at.size() != graph.size()) return;
    EliminationOrder order = Postordered(graph, node_at);
    const double operations = CountOperations(graph, order);
    if (best.node_at.empty() || operations < fewest) {
      best = std::move(order);
      fewest = operations;
    }
  };
  std::vector<int> number(graph.size());
  std::iota(number.begin(), number.end(), 0);
  consider(MinimumDegree(graph, number));
  std::mt19937 random;
  for (unsigned int i = 0; i < kShuffles; ++i) {
    std::shuffle(number.begin(), number.end(), random);
    consider(MinimumDegree(graph, number));
  }
#ifdef VACUUM_GRIPPER_METIS
  consider(NestedDissection(graph));
#endif
  return best;
}

EliminationOrder Postordered(const NodeGraph& graph, const std::vector<int>& node_at) {
  const std::vector<int> postorder = Postorder(EliminationTree(graph, node_at, Inverse(node_at)));
  EliminationOrder order;
  for (const int k : postorder) order.node_at.push_back(node_at[static_cast<std::size_t>(k)]);
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
