#include "vacuum_gripper_sim/core/elimination_branches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

/// Complete binary tree in postorder: left subtree, right subtree, root.
void AppendTree(int num_levels, std::vector<int>* parent) {
  const auto begin = parent->size();
  if (num_levels > 1) {
    AppendTree(num_levels - 1, parent);
    const auto left = parent->size() - 1;
    AppendTree(num_levels - 1, parent);
    const auto right = parent->size() - 1;
    parent->push_back(-1);
    (*parent)[left] = (*parent)[right] = static_cast<int>(parent->size()) - 1;
  } else {
    parent->push_back(-1);
  }
  EXPECT_EQ(parent->size() - begin, (std::size_t{1} << num_levels) - 1);
}

/// Every front in one branch, a branch's fronts contiguous, and the forest that of the fronts.
void ExpectConsistent(const EliminationBranches& cut, const std::vector<int>& parent) {
  std::vector<int> branch_of(parent.size(), -1);
  std::size_t next = 0;
  for (std::size_t b = 0; b < cut.branches.size(); ++b) {
    EXPECT_EQ(cut.branches[b].begin, next);
    next = cut.branches[b].end;
    for (std::size_t s = cut.branches[b].begin; s < next; ++s) branch_of[s] = static_cast<int>(b);
  }
  EXPECT_EQ(next, parent.size());
  std::vector<int> num_children(cut.branches.size(), 0);
  for (std::size_t s = 0; s < parent.size(); ++s) {
    const auto b = static_cast<std::size_t>(branch_of[s]);
    const int above = parent[s] < 0 ? -1 : branch_of[static_cast<std::size_t>(parent[s])];
    if (above == branch_of[s]) continue;
    if (above < 0 && cut.branches.size() == 1) continue;  // all trees together
    EXPECT_EQ(s + 1, cut.branches[b].end);                // only from its top does a branch lead on
    EXPECT_EQ(cut.forest.parent[b], above);
    if (above >= 0) ++num_children[static_cast<std::size_t>(above)];
  }
  EXPECT_EQ(cut.forest.num_children, num_children);
  std::vector<int> leaves;
  for (std::size_t b = 0; b < num_children.size(); ++b) {
    if (num_children[b] == 0) leaves.push_back(static_cast<int>(b));
  }
  EXPECT_TRUE(std::is_permutation(leaves.begin(), leaves.end(), cut.forest.leaves.begin(),
                                  cut.forest.leaves.end()));
  std::vector<bool> begun(cut.branches.size(), false);
  for (const int b : cut.forest.from_top) {
    const int above = cut.forest.parent[static_cast<std::size_t>(b)];
    EXPECT_TRUE(above < 0 || begun[static_cast<std::size_t>(above)]) << b;
    begun[static_cast<std::size_t>(b)] = true;
  }
  EXPECT_EQ(std::count(begun.begin(), begun.end(), true),
            static_cast<std::ptrdiff_t>(cut.branches.size()));
}

TEST(EliminationBranches, OneThreadGetsEverything) {
  std::vector<int> parent;
  AppendTree(4, &parent);
  const auto cut = CutIntoBranches(parent, std::vector<double>(parent.size(), 1.0), 1);
  ASSERT_EQ(cut.branches.size(), 1U);
  EXPECT_EQ(cut.branches[0].begin, 0U);
  EXPECT_EQ(cut.branches[0].end, parent.size());
  EXPECT_EQ(cut.forest.leaves, std::vector<int>{0});
}

// Below a root of cost 1 two halves of 31 each.
TEST(EliminationBranches, TwoThreadsGetHalfATreeEach) {
  std::vector<int> parent;
  AppendTree(6, &parent);
  const std::vector<double> cost(parent.size(), 1.0);
  const auto cut = CutIntoBranches(parent, cost, 2);
  ExpectConsistent(cut, parent);
  EXPECT_EQ(Makespan(cut, cost, 2), 32.0);
  EXPECT_EQ(Makespan(cut, cost, 1), 63.0);
}

// What stands above all cuts is one thread's work.
TEST(EliminationBranches, WhatIsAboveTheCutsTakesItsTime) {
  std::vector<int> parent;
  AppendTree(5, &parent);
  std::vector<double> cost(parent.size(), 1.0);
  cost.back() = 100.0;
  const auto cut = CutIntoBranches(parent, cost, 4);
  ExpectConsistent(cut, parent);
  // Four subtrees of 7, their two parents at the same time, the root.
  EXPECT_EQ(Makespan(cut, cost, 4), 7.0 + 1.0 + 100.0);
}

// Four trees of unequal cost: the costliest begin.
TEST(EliminationBranches, SeparateTreesAreBranches) {
  std::vector<int> parent;
  std::vector<double> cost;
  for (const double each : {1.0, 4.0, 2.0, 3.0}) {
    const int offset = static_cast<int>(parent.size());
    std::vector<int> tree;
    AppendTree(2, &tree);
    for (const int p : tree) parent.push_back(p < 0 ? -1 : p + offset);
    cost.resize(parent.size(), each);
  }
  const auto cut = CutIntoBranches(parent, cost, 2);
  ExpectConsistent(cut, parent);
  EXPECT_EQ(Makespan(cut, cost, 2), 15.0);
}

TEST(EliminationBranches, AFrontAloneIsABranch) {
  const auto cut = CutIntoBranches({-1}, {1.0}, 3);
  ExpectConsistent(cut, {-1});
  EXPECT_EQ(cut.branches.size(), 1U);
}

// Any tree, any costs: never later than alone, never earlier than all threads at work all the time.
TEST(EliminationBranches, AnyTreeIsCutConsistently) {
  std::vector<int> parent(200);
  std::vector<double> cost(200);
  unsigned int state = 1;
  const auto random = [&state] { return (state = state * 1664525U + 1013904223U) >> 16; };
  for (int tree = 0; tree < 20; ++tree) {
    // A postorder: every front takes the roots before it, or some of them, as its children.
    std::vector<int> roots;
    for (std::size_t s = 0; s < parent.size(); ++s) {
      parent[s] = -1;
      cost[s] = 1.0 + random() % 100;
      for (auto n = random() % 4; n > 0 && !roots.empty(); --n) {
        parent[static_cast<std::size_t>(roots.back())] = static_cast<int>(s);
        roots.pop_back();
      }
      roots.push_back(static_cast<int>(s));
    }
    const double total = std::accumulate(cost.begin(), cost.end(), 0.0);
    for (const int num_threads : {1, 2, 3, 8}) {
      const auto cut = CutIntoBranches(parent, cost, num_threads);
      ExpectConsistent(cut, parent);
      EXPECT_LE(Makespan(cut, cost, num_threads), total);
      EXPECT_GE(Makespan(cut, cost, num_threads), total / num_threads);
    }
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
