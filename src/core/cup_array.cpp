#include "vacuum_gripper_sim/core/cup_array.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

/// Copies of a matrix of indices side by side, those of copy k raised by k * stride.
template <typename Matrix>
Matrix RepeatIndices(const Matrix& indices, int stride, int count) {
  Matrix repeated(indices.rows(), indices.cols() * count);
  for (int k = 0; k < count; ++k) {
    repeated.middleCols(k * indices.cols(), indices.cols()) =
        (indices.array() + k * stride).matrix();
  }
  return repeated;
}

std::vector<int> RepeatIndices(const std::vector<int>& indices, int stride, int count) {
  std::vector<int> repeated;
  repeated.reserve(indices.size() * static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    for (const int index : indices) repeated.push_back(index + k * stride);
  }
  return repeated;
}

/// Those of the indices within [begin, end), lowered by `begin`.
std::vector<int> Within(const std::vector<int>& indices, int begin, int end) {
  std::vector<int> within;
  for (const int index : indices) {
    if (index >= begin && index < end) within.push_back(index - begin);
  }
  return within;
}

}  // namespace

CupArray MakeCupArray(const TetMesh& cup, std::vector<CupMount> mounts) {
  const Eigen::Isometry3d X_MR = MountFromRest(cup);
  std::vector<Eigen::Isometry3d> X_RK;
  X_RK.reserve(mounts.size());
  for (const CupMount& mount : mounts) X_RK.push_back(X_MR.inverse() * mount.X_MC * X_MR);
  CupArray array;
  array.mesh = RepeatMesh(cup, X_RK);
  array.cavities =
      RepeatCavity(MakeCavitySurface(cup), cup.num_nodes(), static_cast<int>(mounts.size()));
  array.mounts = std::move(mounts);
  array.rest_M = X_MR * array.mesh.nodes;
  array.rest_of_one = cup.nodes;
  array.nodes_per_cup = cup.num_nodes();
  return array;
}

Eigen::Isometry3d MountFromRest(const TetMesh& cup) {
  double top = -std::numeric_limits<double>::infinity();
  for (const int node : cup.mount_nodes) top = std::max(top, cup.nodes(2, node));
  Eigen::Isometry3d X_MR = Eigen::Isometry3d::Identity();
  X_MR.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  X_MR.translation() = Eigen::Vector3d(0.0, 0.0, top);
  return X_MR;
}

TetMesh RepeatMesh(const TetMesh& cup, const std::vector<Eigen::Isometry3d>& X_RK) {
  const int count = static_cast<int>(X_RK.size());
  const int stride = cup.num_nodes();
  TetMesh array;
  array.source = cup.source;
  array.nodes.resize(3, stride * count);
  for (int k = 0; k < count; ++k) {
    array.nodes.middleCols(k * stride, stride) = X_RK[static_cast<std::size_t>(k)] * cup.nodes;
  }
  array.elements = RepeatIndices(cup.elements, stride, count);
  array.boundary_faces = RepeatIndices(cup.boundary_faces, stride, count);
  array.cavity_faces = RepeatIndices(cup.cavity_faces, stride, count);
  array.mount_nodes = RepeatIndices(cup.mount_nodes, stride, count);
  return array;
}

CavitySurface RepeatCavity(const CavitySurface& cavity, int num_nodes, int count) {
  const int stride = cavity.num_points();
  CavitySurface array;
  array.nodes = RepeatIndices(cavity.nodes, num_nodes, count);
  array.triangles = RepeatIndices(cavity.triangles, stride, count);
  array.border = RepeatIndices(cavity.border, stride, count);
  array.port = RepeatIndices(cavity.port, stride, count);
  for (int k = 0; k < count; ++k) {
    for (const std::vector<int>& neighbours : cavity.neighbours) {
      array.neighbours.push_back(neighbours);
      for (int& neighbour : array.neighbours.back()) neighbour += k * stride;
    }
    array.first_points.push_back((k + 1) * stride);
  }
  return array;
}

CavitySurface CavityOfCup(const CavitySurface& cavities, int cup) {
  const auto k = static_cast<std::size_t>(cup);
  const int begin = cavities.first_points[k], end = cavities.first_points[k + 1];
  CavitySurface surface;
  surface.nodes.assign(cavities.nodes.begin() + begin, cavities.nodes.begin() + end);
  const Eigen::Index num_triangles = cavities.triangles.cols() / cavities.num_cups();
  surface.triangles =
      (cavities.triangles.middleCols(cup * num_triangles, num_triangles).array() - begin).matrix();
  for (int point = begin; point < end; ++point) {
    surface.neighbours.push_back(
        Within(cavities.neighbours[static_cast<std::size_t>(point)], begin, end));
  }
  surface.border = Within(cavities.border, begin, end);
  surface.port = Within(cavities.port, begin, end);
  surface.first_points = {0, end - begin};
  return surface;
}

}  // namespace vacuum_gripper_sim
