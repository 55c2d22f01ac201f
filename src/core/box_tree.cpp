#include "vacuum_gripper_sim/core/box_tree.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace vacuum_gripper_sim {

BoxTree::BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes) : primitives_(boxes.size()) {
  if (boxes.empty()) return;
  Centers centers(3, static_cast<Eigen::Index>(boxes.size()));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    centers.col(static_cast<Eigen::Index>(i)) = boxes[i].center();
  }
  std::iota(primitives_.begin(), primitives_.end(), 0);
  nodes_.reserve(boxes.size() / 2 + 1);
  Build(centers, 0, static_cast<int>(boxes.size()));
  Refit(boxes);
}

/// Divides a range into a node. @returns the node's index.
int BoxTree::Build(const Centers& centers, int begin, int end) {
  const int middle = Halve(centers, begin, end);
  const std::array<int, kWidth + 1> cuts{begin, Halve(centers, begin, middle), middle,
                                         Halve(centers, middle, end), end};
  Node node;
  for (std::size_t k = 0; k < kWidth; ++k) {
    const int count = cuts[k + 1] - cuts[k];
    if (count > kLeafSize) {
      node.child[k] = Build(centers, cuts[k], cuts[k + 1]);
    } else {
      node.child[k] = count > 0 ? cuts[k] : kNothing;
      node.count[k] = count;
      std::sort(primitives_.begin() + cuts[k], primitives_.begin() + cuts[k + 1]);
    }
  }
  nodes_.push_back(node);
  return static_cast<int>(nodes_.size()) - 1;
}

/// Sorts a range into a lower and an upper half. @returns where the upper one begins.
int BoxTree::Halve(const Centers& centers, int begin, int end) {
  const int middle = begin + (end - begin) / 2;
  if (end - begin < 2) return middle;
  Eigen::AlignedBox3d extent;
  for (int i = begin; i < end; ++i) {
    extent.extend(centers.col(primitives_[static_cast<std::size_t>(i)]));
  }
  Eigen::Index axis = 0;
  extent.sizes().maxCoeff(&axis);
  std::nth_element(primitives_.begin() + begin, primitives_.begin() + middle,
                   primitives_.begin() + end, [&](int a, int b) {
                     const double difference = centers(axis, a) - centers(axis, b);
                     return difference < 0.0 || (difference == 0.0 && a < b);
                   });
  return middle;
}

Eigen::AlignedBox3d BoxTree::BoxOf(const Node& node) const {
  return {node.lower.colwise().minCoeff().matrix().transpose(),
          node.upper.colwise().maxCoeff().matrix().transpose()};
}

void BoxTree::Refit(const std::vector<Eigen::AlignedBox3d>& boxes) {
  for (Node& node : nodes_) {
    for (int k = 0; k < kWidth; ++k) {
      const auto child = static_cast<std::size_t>(k);
      const int first = node.child[child], count = node.count[child];
      Eigen::Array3d lower = Eigen::Array3d::Constant(kInfinity), upper = -lower;
      for (int i = 0; i < count; ++i) {
        const auto primitive =
            static_cast<std::size_t>(primitives_[static_cast<std::size_t>(first + i)]);
        lower = lower.min(boxes[primitive].min().array());
        upper = upper.max(boxes[primitive].max().array());
      }
      if (count == 0 && first != kNothing) {
        const Eigen::AlignedBox3d box = BoxOf(nodes_[static_cast<std::size_t>(first)]);
        lower = box.min();
        upper = box.max();
      }
      node.lower.row(k) = lower.transpose();
      node.upper.row(k) = upper.transpose();
    }
  }
  if (!nodes_.empty()) bounds_ = BoxOf(nodes_.back());
}

}  // namespace vacuum_gripper_sim
