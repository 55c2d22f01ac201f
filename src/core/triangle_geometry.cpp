#include "vacuum_gripper_sim/core/triangle_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Matrix3Xi;
using Eigen::Vector3d;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

TrianglePoint NearestOnTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                                const Vector3d& p) {
  const Vector3d ab = b - a, ac = c - a;
  const auto at = [&](double v, double w) {
    return TrianglePoint{{1.0 - v - w, v, w}, (p - a - v * ab - w * ac).squaredNorm()};
  };
  // Coordinates of p along the edges at each corner.
  const Vector3d ap = p - a, bp = p - b, cp = p - c;
  const double b_at_a = ab.dot(ap), c_at_a = ac.dot(ap);
  if (b_at_a <= 0.0 && c_at_a <= 0.0) return {{1.0, 0.0, 0.0}, ap.squaredNorm()};
  const double b_at_b = ab.dot(bp), c_at_b = ac.dot(bp);
  if (b_at_b >= 0.0 && c_at_b <= b_at_b) return {{0.0, 1.0, 0.0}, bp.squaredNorm()};
  const double b_at_c = ab.dot(cp), c_at_c = ac.dot(cp);
  if (c_at_c >= 0.0 && b_at_c <= c_at_c) return {{0.0, 0.0, 1.0}, cp.squaredNorm()};

  // Areas of the triangles of p and an edge, signed: negative beyond the edge.
  const double area_ab = b_at_a * c_at_b - b_at_b * c_at_a;
  if (area_ab <= 0.0 && b_at_a >= 0.0 && b_at_b <= 0.0) {
    TrianglePoint point = at(b_at_a / (b_at_a - b_at_b), 0.0);
    point.weights.z() = 0.0;
    return point;
  }
  const double area_ca = b_at_c * c_at_a - b_at_a * c_at_c;
  if (area_ca <= 0.0 && c_at_a >= 0.0 && c_at_c <= 0.0) {
    return at(0.0, c_at_a / (c_at_a - c_at_c));
  }
  const double area_bc = b_at_b * c_at_c - b_at_c * c_at_b;
  const double from_b = c_at_b - b_at_b, from_c = b_at_c - c_at_c;
  if (area_bc <= 0.0 && from_b >= 0.0 && from_c >= 0.0) {
    const double w = from_b / (from_b + from_c);
    TrianglePoint point = at(1.0 - w, w);
    point.weights.x() = 0.0;
    return point;
  }
  const double area = area_ab + area_bc + area_ca;
  return at(area_ca / area, area_ab / area);
}

TriangleTopology::TriangleTopology(const Matrix3Xi& triangles, int num_vertices)
    : neighbors(Matrix3Xi::Constant(3, triangles.cols(), int{kNone})),
      corners_begin(Index(num_vertices) + 1, 0),
      corners(static_cast<std::size_t>(triangles.size())) {
  struct Side {
    std::pair<int, int> ends;  // ascending
    int corner;                // 3 t + k
  };
  std::vector<Side> sides;
  sides.reserve(corners.size());
  for (int t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      sides.push_back({std::minmax({triangles(k, t), triangles((k + 1) % 3, t)}), 3 * t + k});
      ++corners_begin[Index(triangles(k, t)) + 1];
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.ends, a.corner) < std::tie(b.ends, b.corner);
  });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].ends == sides[i].ends) ++end;
    if (end - i == 2) {
      const int a = sides[i].corner, b = sides[i + 1].corner;
      neighbors(a % 3, a / 3) = b / 3;
      neighbors(b % 3, b / 3) = a / 3;
    }
    i = end;
  }
  for (std::size_t v = 1; v < corners_begin.size(); ++v) corners_begin[v] += corners_begin[v - 1];
  std::vector<int> place(corners_begin.begin(), corners_begin.end() - 1);
  for (int t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) corners[Index(place[Index(triangles(k, t))]++)] = 3 * t + k;
  }
}

double CornerAngle(const Matrix3Xi& triangles, const Matrix3Xd& vertices, int t, int k) {
  const Vector3d corner = vertices.col(triangles(k, t));
  const Vector3d u = vertices.col(triangles((k + 1) % 3, t)) - corner;
  const Vector3d v = vertices.col(triangles((k + 2) % 3, t)) - corner;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

Vector3d TriangleNormal(const Matrix3Xi& triangles, const Matrix3Xd& vertices, int t) {
  const Vector3d a = vertices.col(triangles(0, t));
  const Vector3d b = vertices.col(triangles(1, t));
  const Vector3d c = vertices.col(triangles(2, t));
  return (b - a).cross(c - a).stableNormalized();
}

}  // namespace vacuum_gripper_sim
