#include "vacuum_gripper_sim/core/cavity_size.h"

#include <algorithm>
#include <cstddef>

namespace vacuum_gripper_sim {

CavitySize SizeOfCavity(const CavitySurface& surface, int cup, const std::vector<bool>& wet,
                        const Eigen::Matrix3Xd& x_W, const Eigen::Matrix3Xd& area_vectors) {
  const auto k = static_cast<std::size_t>(cup);
  const auto begin = static_cast<std::size_t>(surface.first_points[k]);
  const auto end = static_cast<std::size_t>(surface.first_points[k + 1]);
  CavitySize size;
  Eigen::Vector3d apex = Eigen::Vector3d::Zero();
  int num_edge_points = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (!wet[i]) continue;
    size.area_W += area_vectors.col(static_cast<Eigen::Index>(i));
    const auto& neighbours = surface.neighbours[i];
    const bool on_edge = std::any_of(neighbours.begin(), neighbours.end(),
                                     [&](int n) { return !wet[static_cast<std::size_t>(n)]; });
    if (!on_edge) continue;
    apex += x_W.col(surface.nodes[i]);
    ++num_edge_points;
  }
  if (num_edge_points == 0) return size;
  apex /= num_edge_points;
  // A cone over every wet point's area vector from the middle of the edge, in whose plane the edge
  // lies.
  for (std::size_t i = begin; i < end; ++i) {
    if (!wet[i]) continue;
    size.volume +=
        (x_W.col(surface.nodes[i]) - apex).dot(area_vectors.col(static_cast<Eigen::Index>(i))) /
        3.0;
  }
  return size;
}

std::array<std::uint32_t, kNumZones> CountZones(const CavitySurface& surface, int cup,
                                                const std::vector<Zone>& zones) {
  const auto k = static_cast<std::size_t>(cup);
  std::array<std::uint32_t, kNumZones> counts{};
  for (int point = surface.first_points[k]; point < surface.first_points[k + 1]; ++point) {
    ++counts[static_cast<std::size_t>(zones[static_cast<std::size_t>(point)])];
  }
  return counts;
}

}  // namespace vacuum_gripper_sim
