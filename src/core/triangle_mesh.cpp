#include "vacuum_gripper_sim/core/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "vacuum_gripper_sim/core/mesh_repair.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Matrix3Xi;
using Eigen::Vector3d;

/// Nearer than this the direction from the nearest point is rounding alone. [m]
constexpr double kTouching = 1e-10;
/// What rounding may add to a squared distance, relatively: no equally near triangle is left out.
constexpr double kRounding = 1e-12;

std::size_t Index(Eigen::Index i) { return static_cast<std::size_t>(i); }

template <typename... Parts>
[[noreturn]] void Fail(const std::string& name, const Parts&... parts) {
  std::ostringstream message;
  message << name << ": ";
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

void Check(const std::string& name, const Matrix3Xd& vertices, const Matrix3Xi& triangles) {
  if (triangles.cols() == 0) Fail(name, "the mesh has no triangles, must have at least one");
  for (Eigen::Index v = 0; v < vertices.cols(); ++v) {
    if (vertices.col(v).allFinite()) continue;
    Fail(name, "vertex ", v, " (from 0) = (", vertices(0, v), ", ", vertices(1, v), ", ",
         vertices(2, v), "), must be finite");
  }
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (triangles(k, t) >= 0 && triangles(k, t) < vertices.cols()) continue;
      Fail(name, "triangle ", t, " (from 0) names vertex ", triangles(k, t), ", must be in 0 .. ",
           vertices.cols() - 1);
    }
  }
}

}  // namespace

TriangleMesh::TriangleMesh(std::string name, const Matrix3Xd& vertices, const Matrix3Xi& triangles)
    : name_(std::move(name)) {
  Check(name_, vertices, triangles);
  RepairedTriangles mesh = RepairTriangles(vertices, triangles);
  vertices_ = std::move(mesh.vertices);
  triangles_ = std::move(mesh.triangles);
  shell_ = std::move(mesh.shell);
  shell_closed_ = std::move(mesh.closed);
  merged_vertices_ = mesh.merged_vertices;
  dropped_triangles_ = mesh.dropped_triangles;
  turned_triangles_ = mesh.turned_triangles;
  for (int t = 0; t < num_triangles(); ++t) {
    if (!mesh.flat[Index(t)]) solid_triangles_.push_back(t);
  }
  if (solid_triangles_.empty()) {
    Fail(name_, "none of the mesh's ", triangles.cols(), " triangles has an area, one must have");
  }

  topology_ = TriangleTopology(triangles_, static_cast<int>(vertices_.cols()));
  normals_.setZero(3, triangles_.cols());
  corners_.resize(9, static_cast<Eigen::Index>(solid_triangles_.size()));
  std::vector<Eigen::AlignedBox3d> boxes(solid_triangles_.size());
  for (std::size_t i = 0; i < solid_triangles_.size(); ++i) {
    const int t = solid_triangles_[i];
    normals_.col(t) = TriangleNormal(triangles_, vertices_, t);
    for (int k = 0; k < 3; ++k) {
      const Vector3d corner = vertices_.col(triangles_(k, t));
      corners_.col(static_cast<Eigen::Index>(i)).segment<3>(3 * k) = corner;
      boxes[i].extend(corner);
    }
  }
  tree_ = BoxTree(boxes);

  vertex_normals_.setZero(3, vertices_.cols());
  on_border_.assign(Index(vertices_.cols()), false);
  for (int t = 0; t < num_triangles(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = triangles_(k, t);
      vertex_normals_.col(v) += CornerAngle(triangles_, vertices_, t, k) * normals_.col(t);
      if (topology_.neighbors(k, t) != TriangleTopology::kNone) continue;
      on_border_[Index(v)] = on_border_[Index(triangles_((k + 1) % 3, t))] = true;
    }
  }
}

bool TriangleMesh::closed() const {
  return std::all_of(shell_closed_.begin(), shell_closed_.end(),
                     [](bool closed) { return closed; });
}

TrianglePoint TriangleMesh::NearestOn(int triangle, const Vector3d& p) const {
  return NearestOnTriangle(vertices_.col(triangles_(0, triangle)),
                           vertices_.col(triangles_(1, triangle)),
                           vertices_.col(triangles_(2, triangle)), p);
}

std::optional<MeshPoint> TriangleMesh::Nearest(const Vector3d& p, double max_distance,
                                               int hint) const {
  int best = kNoHint;
  TrianglePoint best_at;
  best_at.squared_distance = max_distance * max_distance;
  if (hint != kNoHint && !normals_.col(hint).isZero(0.0)) {
    const TrianglePoint at = NearestOn(hint, p);
    if (at.squared_distance <= best_at.squared_distance) {
      best = hint;
      best_at = at;
    }
  }
  double bound = best_at.squared_distance * (1.0 + kRounding);
  // Of equally near triangles the first counts, whatever the order in which they are met.
  tree_.VisitNear(p, &bound, [&](int primitive) {
    const int triangle = solid_triangles_[Index(primitive)];
    const auto corners = corners_.col(primitive);
    const TrianglePoint at =
        NearestOnTriangle(corners.segment<3>(0), corners.segment<3>(3), corners.segment<3>(6), p);
    if (at.squared_distance > best_at.squared_distance) return;
    if (at.squared_distance == best_at.squared_distance && best != kNoHint && best <= triangle) {
      return;
    }
    best = triangle;
    best_at = at;
    bound = best_at.squared_distance * (1.0 + kRounding);
  });
  if (best == kNoHint) return std::nullopt;
  return Describe(best, best_at, p);
}

MeshPoint TriangleMesh::Describe(int triangle, const TrianglePoint& at, const Vector3d& p) const {
  MeshPoint point;
  point.triangle = triangle;
  point.weights = at.weights;
  point.rim.setZero();
  const Eigen::Array3d weights = at.weights.array();
  const auto corner = [&](int k) { return Vector3d(vertices_.col(triangles_(k, triangle))); };
  if ((weights != 0.0).all()) {
    point.normal = normals_.col(triangle);
    point.distance = point.normal.dot(p - corner(0));
    return point;
  }
  Vector3d nearest = Vector3d::Zero();
  Vector3d outward = Vector3d::Zero();
  bool border = false;
  for (int k = 0; k < 3; ++k) {
    nearest += weights(k) * corner(k);
    if (weights(k) == 1.0) {
      const int vertex = triangles_(k, triangle);
      outward = vertex_normals_.col(vertex);
      border = on_border_[Index(vertex)];
    }
    if (weights((k + 2) % 3) == 0.0 && weights(k) != 0.0 && weights((k + 1) % 3) != 0.0) {
      outward = Pseudonormal(triangles_, vertices_, topology_, triangle, at.weights,
                             [&](int t) { return normals_.col(t); });
      border = topology_.neighbors(k, triangle) == TriangleTopology::kNone;
    }
  }
  const Vector3d way = p - nearest;
  const double length = std::sqrt(at.squared_distance);
  const double sign = way.dot(outward) < 0.0 ? -1.0 : 1.0;
  point.distance = sign * length;
  point.normal =
      length > kTouching ? Vector3d(sign / length * way) : Vector3d(outward.normalized());
  if (border && !shell_closed(shell(triangle))) AddRim(way, outward.normalized(), &point);
  return point;
}

void TriangleMesh::AddRim(const Vector3d& way, const Vector3d& pseudonormal,
                          MeshPoint* point) const {
  const Vector3d along = way - way.dot(pseudonormal) * pseudonormal;
  const double length = along.norm();
  if (length <= kTouching) return;
  point->rim_distance = length;
  point->rim = along / length;
}

double MeshPoint::rim_height() const {
  const double height = std::sqrt(std::max(0.0, distance * distance - rim_distance * rim_distance));
  return std::copysign(height, distance);
}

MeshPoint TriangleMesh::SeenFrom(int side, const MeshPoint& point) const {
  MeshPoint seen = point;
  if (shell_closed(shell(point.triangle))) return seen;
  const double sign = side < 0 ? -1.0 : 1.0;
  const double height = sign * point.rim_height();
  if (point.rim_distance > 0.0 && height < 0.0 && height > -kBorderTolerance) {
    seen.distance = point.rim_distance;
    seen.normal = point.rim;
    return seen;
  }
  const bool turn = point.rim_distance > 0.0 ? point.distance < 0.0 : side < 0;
  if (turn) {
    seen.distance = -point.distance;
    seen.normal = -point.normal;
  }
  return seen;
}

}  // namespace vacuum_gripper_sim
