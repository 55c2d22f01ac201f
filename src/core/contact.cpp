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

NodeContact NarrowPhase::Ahead(int pair, const Eigen::Matrix3Xd& x1_W) const {
  const SurfaceDistance& start = seen(pair);
  const double gap =
      start.distance + start.normal.dot(x1_W.col(node(pair)) - x0_W_.col(node(pair)));
  return {node(pair), surface(pair), gap, start.normal};
}

}  // namespace vacuum_gripper_sim
