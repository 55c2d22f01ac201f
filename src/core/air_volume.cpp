#include "vacuum_gripper_sim/core/air_volume.h"

#include <algorithm>
#include <cstddef>

namespace vacuum_gripper_sim {
namespace {

/// How far a ray goes to the first surface, at most `limit`: sphere tracing. [m]
double RayLength(const Eigen::Vector3d& from_W, const Eigen::Vector3d& axis_W, double limit,
                 const std::function<double(const Eigen::Vector3d& p_W)>& distance) {
  constexpr double kClose = 1e-6;  // m
  constexpr int kMaxSteps = 30;
  double length = 0.0;
  for (int i = 0; i < kMaxSteps && length < limit; ++i) {
    const double free_way = distance(from_W + length * axis_W);
    if (free_way < kClose) break;
    length += free_way;
  }
  return std::clamp(length, 0.0, std::max(limit, 0.0));
}

}  // namespace

double AirVolume(const CavitySurface& surface, int cup, const std::vector<bool>& wet,
                 const Eigen::Matrix3Xd& x_W, const Eigen::Matrix3Xd& area_vectors,
                 const Eigen::Vector3d& axis_W,
                 const std::function<double(const Eigen::Vector3d& p_W)>& distance) {
  const auto k = static_cast<std::size_t>(cup);
  double mouth = 0.0;  // mean height along the axis of the dry points next to wet ones
  int num_mouth_points = 0;
  for (int i = surface.first_points[k]; i < surface.first_points[k + 1]; ++i) {
    const auto point = static_cast<std::size_t>(i);
    const auto& neighbours = surface.neighbours[point];
    const bool at_mouth =
        !wet[point] && std::any_of(neighbours.begin(), neighbours.end(),
                                   [&](int n) { return wet[static_cast<std::size_t>(n)]; });
    if (!at_mouth) continue;
    mouth += axis_W.dot(x_W.col(surface.nodes[point]));
    ++num_mouth_points;
  }
  if (num_mouth_points == 0) return 0.0;
  mouth /= num_mouth_points;
  double volume = 0.0;
  for (int i = surface.first_points[k]; i < surface.first_points[k + 1]; ++i) {
    const auto point = static_cast<std::size_t>(i);
    if (!wet[point]) continue;
    const Eigen::Vector3d p_W = x_W.col(surface.nodes[point]);
    const double height = RayLength(p_W, axis_W, mouth - axis_W.dot(p_W), distance);
    volume -= height * axis_W.dot(area_vectors.col(i));
  }
  return std::max(volume, 0.0);
}

double SweptVolume(const CavitySurface& surface, int cup, const std::vector<bool>& wet,
                   const Eigen::Matrix3Xd& motion_W, const Eigen::Matrix3Xd& areas_begin,
                   const Eigen::Matrix3Xd& areas_end) {
  const auto k = static_cast<std::size_t>(cup);
  double volume = 0.0;
  for (int i = surface.first_points[k]; i < surface.first_points[k + 1]; ++i) {
    if (!wet[static_cast<std::size_t>(i)]) continue;
    volume += 0.5 * (areas_begin.col(i) + areas_end.col(i)).dot(motion_W.col(i));
  }
  return volume;
}

}  // namespace vacuum_gripper_sim
