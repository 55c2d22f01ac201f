#include "vacuum_gripper_sim/core/edge_ways.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

/// Where an edge is measured, as fractions of its length.
constexpr double kPlaces[] = {0.25, 0.5, 0.75};

}  // namespace

EdgeWays::EdgeWays(const CavitySurface& surface) : nodes_(surface.nodes) {
  std::map<std::pair<int, int>, int> opposite;  // of the triangle that runs through the edge first
  for (int t = 0; t < surface.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = surface.triangles(k, t), b = surface.triangles((k + 1) % 3, t);
      const int across = surface.triangles((k + 2) % 3, t);
      const auto [place, is_new] = opposite.try_emplace(std::minmax(a, b), across);
      if (!is_new) edges_.push_back({a, b, place->second, across, 0.0});
    }
  }
}

std::vector<EdgeWay> EdgeWays::Find(const std::vector<double>& phi, double open_gap,
                                    const Eigen::Matrix3Xd& x_W,
                                    const DistanceToSurfaces& distance) const {
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<EdgeWay> ways;
  for (EdgeWay edge : edges_) {
    if (phi[index(edge.a)] > open_gap || phi[index(edge.b)] > open_gap) continue;
    const Eigen::Vector3d a = x_W.col(nodes_[index(edge.a)]);
    const Eigen::Vector3d b = x_W.col(nodes_[index(edge.b)]);
    for (const double t : kPlaces) edge.gap = std::max(edge.gap, distance((1.0 - t) * a + t * b));
    if (edge.gap > open_gap) ways.push_back(edge);
  }
  return ways;
}

}  // namespace vacuum_gripper_sim
