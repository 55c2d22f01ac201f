#include "vacuum_gripper_sim/core/contact.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace vacuum_gripper_sim {

std::vector<double> NearestDistances(const std::vector<RigidSurface>& surfaces,
                                     const std::vector<int>& nodes, const Eigen::Matrix3Xd& x_W) {
  std::vector<double> nearest(nodes.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const RigidSurface& surface : surfaces) {
      nearest[i] = std::min(nearest[i], Distance(surface, x_W.col(nodes[i])).distance);
    }
  }
  return nearest;
}

void NarrowPhase::Begin(const std::vector<RigidSurface>& surfaces, const std::vector<int>& nodes,
                        const Eigen::Matrix3Xd& x0_W) {
  surfaces_ = &surfaces;
  nodes_ = nodes;
  x0_W_ = x0_W;
  seen_.clear();
  for (const int node : nodes) {
    for (const RigidSurface& surface : surfaces) {
      seen_.push_back(Distance(surface, x0_W.col(node)));
    }
  }
}

Contact NarrowPhase::Ahead(std::size_t pair, const Eigen::Matrix3Xd& x1_W) const {
  const SurfaceDistance& seen = seen_[pair];
  const int node = nodes_[pair / surfaces_->size()];
  const double gap = seen.distance + seen.normal.dot(x1_W.col(node) - x0_W_.col(node));
  return {node, static_cast<int>(pair % surfaces_->size()), gap, seen.normal};
}

Contact NarrowPhase::Ahead(int node, int surface, const Eigen::Matrix3Xd& x1_W) const {
  const auto place = std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin();
  return Ahead(
      static_cast<std::size_t>(place) * surfaces_->size() + static_cast<std::size_t>(surface),
      x1_W);
}

Contact NarrowPhase::At(int node, int surface, const Eigen::Matrix3Xd& x_W) const {
  const SurfaceDistance seen =
      Distance((*surfaces_)[static_cast<std::size_t>(surface)], x_W.col(node));
  return {node, surface, seen.distance, seen.normal};
}

}  // namespace vacuum_gripper_sim
