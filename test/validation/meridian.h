#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// A piece of a meridian section: two points (distance from the cup's axis, height). [m]
struct MeridianSegment {
  Eigen::Vector2d begin;
  Eigen::Vector2d end;
};
using Meridian = std::vector<MeridianSegment>;

/// The whole deformed boundary as a grid of lines, turned about the axis x = y = 0 into one half
/// plane. @param x Positions of all nodes, 3 by #nodes. [m]
inline Meridian MeridianOf(const TetMesh& mesh, const Eigen::Matrix3Xd& x) {
  constexpr int kDivisions = 4;  // of a face's edge
  Meridian meridian;
  for (int f = 0; f < mesh.boundary_faces.cols(); ++f) {
    const auto at = [&](int i, int j) {
      const double a = static_cast<double>(i) / kDivisions;
      const double b = static_cast<double>(j) / kDivisions;
      const double c = 1.0 - a - b;
      const auto node = [&](int k) { return x.col(mesh.boundary_faces(k, f)); };
      Eigen::Vector3d p;
      if (mesh.quadratic()) {
        p = a * (2.0 * a - 1.0) * node(0) + b * (2.0 * b - 1.0) * node(1) +
            c * (2.0 * c - 1.0) * node(2) +
            4.0 * (a * b * node(3) + b * c * node(4) + c * a * node(5));
      } else {
        p = a * node(0) + b * node(1) + c * node(2);
      }
      return Eigen::Vector2d(p.head<2>().norm(), p.z());
    };
    for (int i = 0; i < kDivisions; ++i) {
      for (int j = 0; j < kDivisions - i; ++j) {
        meridian.push_back({at(i, j), at(i + 1, j)});
        meridian.push_back({at(i, j), at(i, j + 1)});
        meridian.push_back({at(i + 1, j), at(i, j + 1)});
      }
    }
  }
  return meridian;
}

/// Largest distance from the begin of a segment of `from` to the nearest segment of `to`. [m]
inline double Farthest(const Meridian& from, const Meridian& to) {
  double farthest = 0.0;
  for (const MeridianSegment& origin : from) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const MeridianSegment& segment : to) {
      const Eigen::Vector2d edge = segment.end - segment.begin;
      const Eigen::Vector2d offset = origin.begin - segment.begin;
      const double length_squared = std::max(edge.squaredNorm(), 1e-30);
      const double t = std::clamp(offset.dot(edge) / length_squared, 0.0, 1.0);
      nearest = std::min(nearest, (offset - t * edge).squaredNorm());
    }
    farthest = std::max(farthest, std::sqrt(nearest));
  }
  return farthest;
}

}  // namespace vacuum_gripper_sim
