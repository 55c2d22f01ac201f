#include "vacuum_gripper_sim/core/element_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <set>
#include <vector>

#include "support/block_mesh.h"

namespace vacuum_gripper_sim {
namespace {

TEST(ElementOrder, HasEveryElementOnce) {
  const TetMesh mesh = MakeBlock(5, 2, 3, {0.02, 0.01, 0.01}, true);
  std::vector<int> order = OrderByNeighbours(mesh);
  std::sort(order.begin(), order.end());
  std::vector<int> all(static_cast<std::size_t>(mesh.num_elements()));
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}

// A bar's order goes along it, whatever its elements' numbers: its two halves meet in two layers of
// nodes at most.
TEST(ElementOrder, HalvesOfABarHaveFewNodesInCommon) {
  constexpr int kCells = 12;
  TetMesh mesh = MakeBlock(kCells, 2, 2, {0.12, 0.02, 0.02}, false);
  for (Eigen::Index e = 0; e < mesh.elements.cols(); ++e) {  // shuffled: 7 is prime to their number
    if (const Eigen::Index other = 7 * e % mesh.elements.cols(); other > e) {
      mesh.elements.col(e).swap(mesh.elements.col(other));
    }
  }
  const std::vector<int> order = OrderByNeighbours(mesh);
  std::set<int> nodes[2];
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (Eigen::Index a = 0; a < mesh.elements.rows(); ++a) {
      nodes[2 * i / order.size()].insert(mesh.elements(a, order[i]));
    }
  }
  std::vector<int> common;
  std::set_intersection(nodes[0].begin(), nodes[0].end(), nodes[1].begin(), nodes[1].end(),
                        std::back_inserter(common));
  EXPECT_GE(common.size(), 1U);
  EXPECT_LE(common.size(), 2U * 3 * 3);
}

}  // namespace
}  // namespace vacuum_gripper_sim
