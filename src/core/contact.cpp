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

template <typename Predicate>
std::vector<Contact> NarrowPhase::Select(const Eigen::Matrix3Xd& x1_W,
                                         const Predicate& wanted) const {
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Eigen::Vector3d way = x1_W.col(nodes_[i]) - x0_W_.col(nodes_[i]);
    for (std::size_t s = 0; s < surfaces_->size(); ++s) {
      const SurfaceDistance& seen = seen_[i * surfaces_->size() + s];
      const double gap = seen.distance + seen.normal.dot(way);
      if (wanted(seen.distance, gap)) {
        contacts.push_back({nodes_[i], static_cast<int>(s), gap, seen.normal});
      }
    }
  }
  return contacts;
}

std::vector<Contact> NarrowPhase::Near(const Eigen::Matrix3Xd& x1_W, double alarm_distance) const {
  return Select(x1_W, [&](double start, double) { return start < alarm_distance; });
}

std::vector<Contact> NarrowPhase::Reaching(const Eigen::Matrix3Xd& x1_W, double gap) const {
  return Select(x1_W, [&](double, double end) { return end < gap; });
}

Contact NarrowPhase::Ahead(int node, int surface, const Eigen::Matrix3Xd& x1_W) const {
  const auto place = std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin();
  const SurfaceDistance& seen = seen_[static_cast<std::size_t>(place) * surfaces_->size() +
                                      static_cast<std::size_t>(surface)];
  const double gap = seen.distance + seen.normal.dot(x1_W.col(node) - x0_W_.col(node));
  return {node, surface, gap, seen.normal};
}

Contact NarrowPhase::At(int node, int surface, const Eigen::Matrix3Xd& x_W) const {
  const SurfaceDistance seen =
      Distance((*surfaces_)[static_cast<std::size_t>(surface)], x_W.col(node));
  return {node, surface, seen.distance, seen.normal};
}

}  // namespace vacuum_gripper_sim
