#include "vacuum_gripper_sim/core/elimination_branches.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

/// After so many cuts more of them find no better share.
constexpr int kCutsPerThread = 12;

struct Tree {
  std::vector<std::size_t> first;  // front of each front's subtree
  std::vector<double> cost;        // of each front's subtree
};

Tree SumUp(const std::vector<int>& parent, const std::vector<double>& cost) {
  Tree tree{std::vector<std::size_t>(parent.size()), cost};
  std::iota(tree.first.begin(), tree.first.end(), std::size_t{0});
  for (std::size_t s = 0; s < parent.size(); ++s) {
    if (parent[s] < 0) continue;
    const auto above = static_cast<std::size_t>(parent[s]);
    tree.first[above] = std::min(tree.first[above], tree.first[s]);
    tree.cost[above] += tree.cost[s];
  }
  return tree;
}

/// @param is_cut Of each front: does it stand alone?
EliminationBranches MakeBranches(const std::vector<int>& parent, const Tree& tree,
                                 const std::vector<bool>& is_cut) {
  EliminationBranches result;
  std::vector<int> branch_of(parent.size(), -1);  // of the topmost front
  const auto ends_branch = [&](std::size_t s) {
    return is_cut[s] || parent[s] < 0 || is_cut[static_cast<std::size_t>(parent[s])];
  };
  for (std::size_t s = 0; s < parent.size(); ++s) {
    if (!ends_branch(s)) continue;
    branch_of[s] = static_cast<int>(result.branches.size());
    result.branches.push_back({is_cut[s] ? s : tree.first[s], s + 1});
  }
  Crew::Forest& forest = result.forest;
  forest.num_children.assign(result.branches.size(), 0);
  for (const EliminationBranches::Branch& branch : result.branches) {
    const int above = parent[branch.end - 1];
    forest.parent.push_back(above < 0 ? -1 : branch_of[static_cast<std::size_t>(above)]);
    if (above >= 0) ++forest.num_children[static_cast<std::size_t>(forest.parent.back())];
  }
  for (std::size_t b = 0; b < result.branches.size(); ++b) {
    if (forest.num_children[b] == 0) forest.leaves.push_back(static_cast<int>(b));
  }
  const auto cost_of = [&](int b) {
    return tree.cost[result.branches[static_cast<std::size_t>(b)].end - 1];
  };
  std::stable_sort(forest.leaves.begin(), forest.leaves.end(),
                   [&](int a, int b) { return cost_of(a) > cost_of(b); });
  for (int b = static_cast<int>(result.branches.size()); b-- > 0;) {
    if (forest.num_children[static_cast<std::size_t>(b)] > 0) forest.from_top.push_back(b);
  }
  forest.from_top.insert(forest.from_top.end(), forest.leaves.begin(), forest.leaves.end());
  return result;
}

EliminationBranches OneBranch(std::size_t num_fronts) {
  EliminationBranches result;
  result.branches = {{0, num_fronts}};
  result.forest = {{-1}, {0}, {0}, {0}};
  return result;
}

}  // namespace

EliminationBranches CutIntoBranches(const std::vector<int>& parent, const std::vector<double>& cost,
                                    int num_threads) {
  EliminationBranches best = OneBranch(parent.size());
  if (num_threads == 1) return best;
  double best_makespan = Makespan(best, cost, num_threads);
  const Tree tree = SumUp(parent, cost);
  std::vector<bool> is_cut(parent.size(), false);
  // Whole subtrees, by their topmost front; the costliest first.
  std::priority_queue<std::pair<double, std::size_t>> subtrees;
  for (std::size_t s = 0; s < parent.size(); ++s) {
    if (parent[s] < 0) subtrees.emplace(tree.cost[s], s);
  }
  std::vector<std::vector<std::size_t>> children(parent.size());
  for (std::size_t s = 0; s < parent.size(); ++s) {
    if (parent[s] >= 0) children[static_cast<std::size_t>(parent[s])].push_back(s);
  }
  for (int cut = 0; cut <= kCutsPerThread * num_threads && !subtrees.empty(); ++cut) {
    EliminationBranches branches = MakeBranches(parent, tree, is_cut);
    const double makespan = Makespan(branches, cost, num_threads);
    if (makespan < best_makespan) {
      best_makespan = makespan;
      best = std::move(branches);
    }
    const std::size_t costliest = subtrees.top().second;
    subtrees.pop();
    is_cut[costliest] = true;
    for (const std::size_t child : children[costliest]) subtrees.emplace(tree.cost[child], child);
  }
  return best;
}

double Makespan(const EliminationBranches& branches, const std::vector<double>& cost,
                int num_threads) {
  const Crew::Forest& forest = branches.forest;
  const auto cost_of = [&](int b) {
    const auto& branch = branches.branches[static_cast<std::size_t>(b)];
    return std::accumulate(cost.begin() + static_cast<std::ptrdiff_t>(branch.begin),
                           cost.begin() + static_cast<std::ptrdiff_t>(branch.end), 0.0);
  };
  std::vector<int> missing = forest.num_children;
  std::size_t next = 0;
  using Event = std::pair<double, int>;  // a branch done, and when
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
  const auto begin_leaf = [&](double now) {
    if (next == forest.leaves.size()) return;
    const int leaf = forest.leaves[next++];
    events.emplace(now + cost_of(leaf), leaf);
  };
  for (int thread = 0; thread < num_threads; ++thread) begin_leaf(0.0);
  double now = 0.0;
  while (!events.empty()) {
    const int done = events.top().second;
    now = events.top().first;
    events.pop();
    const int parent = forest.parent[static_cast<std::size_t>(done)];
    if (parent >= 0 && --missing[static_cast<std::size_t>(parent)] == 0) {
      events.emplace(now + cost_of(parent), parent);
    } else {
      begin_leaf(now);
    }
  }
  return now;
}

}  // namespace vacuum_gripper_sim
