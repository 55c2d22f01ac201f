#include "vacuum_gripper_sim/core/contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>

namespace vacuum_gripper_sim {
namespace {

/// Nodes farther from a mesh than this when a step begins need not know how far. [m]
constexpr double kReach = 0.01;

bool IsMesh(const RigidSurface& surface) { return std::holds_alternative<Mesh>(surface.shape); }

}  // namespace

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
  const bool any_mesh = std::any_of(surfaces.begin(), surfaces.end(), IsMesh);
  if (any_mesh) sightings_.resize(nodes.size() * surfaces.size());
  for (const int node : nodes) {
    for (const RigidSurface& surface : surfaces) {
      const Eigen::Vector3d p_W = x0_W.col(node);
      if (IsMesh(surface)) {
        const SurfaceDistance seen = sightings_[seen_.size()].BeginStep(surface, p_W, kReach);
        seen_.push_back(seen);
      } else {
        seen_.push_back(Distance(surface, p_W));
      }
    }
  }
}

SurfaceDistance NarrowPhase::Look(std::size_t pair, const RigidSurface& surface,
                                  const Eigen::Vector3d& p_W) {
  if (!IsMesh(surface)) return Distance(surface, p_W);
  return sightings_[pair].Look(surface, p_W);
}

NodeContact NarrowPhase::At(int pair, const std::vector<RigidSurface>& surfaces,
                            const Eigen::Matrix3Xd& x1_W) {
  const SurfaceDistance seen =
      Look(static_cast<std::size_t>(pair), surfaces[static_cast<std::size_t>(surface(pair))],
           x1_W.col(node(pair)));
  return {node(pair), surface(pair), seen.distance, seen.normal};
}

void NarrowPhase::Nearest(const std::vector<RigidSurface>& surfaces, const Eigen::Matrix3Xd& x1_W,
                          std::vector<double>* nearest) {
  nearest->assign(nodes_.size(), std::numeric_limits<double>::infinity());
  std::size_t pair = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    double& distance = (*nearest)[i];
    for (const RigidSurface& surface : surfaces) {
      distance = std::min(distance, Look(pair++, surface, x1_W.col(nodes_[i])).distance);
    }
  }
}

int NarrowPhase::NearestSurface(int node) const {
  const auto place = std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin();
  const auto num_surfaces = static_cast<int>(surfaces_->size());
  const int first = static_cast<int>(place) * num_surfaces;
  const auto distance_to = [&](int surface) {
    const double seen_distance = seen(first + surface).distance;
    const RigidSurface& candidate = (*surfaces_)[static_cast<std::size_t>(surface)];
    if (!IsMesh(candidate) || seen_distance < kReach) return seen_distance;
    return std::abs(Distance(candidate, x0_W_.col(node)).distance);
  };
  int nearest = 0;
  double nearest_distance = std::numeric_limits<double>::infinity();
  for (int surface = 0; surface < num_surfaces && num_surfaces > 1; ++surface) {
    // What was seen is at most how far it is.
    if (seen(first + surface).distance >= nearest_distance) continue;
    const double distance = distance_to(surface);
    if (distance >= nearest_distance) continue;
    nearest_distance = distance;
    nearest = surface;
  }
  return nearest;
}

NodeContact NarrowPhase::Ahead(int pair, const Eigen::Matrix3Xd& x1_W) const {
  const SurfaceDistance& start = seen(pair);
  const double gap =
      start.distance + start.normal.dot(x1_W.col(node(pair)) - x0_W_.col(node(pair)));
  return {node(pair), surface(pair), gap, start.normal};
}

}  // namespace vacuum_gripper_sim
