#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// Points of a meridian half plane: distance from the cup's axis and height. [m]
using MeridianPoints = std::vector<Eigen::Vector2d>;

/// Points spread over the whole deformed boundary, turned about the axis x = y = 0 into one half
/// plane. @param x Positions of all nodes, 3 by #nodes. [m]
inline MeridianPoints MeridianOf(const TetMesh& mesh, const Eigen::Matrix3Xd& x) {
  constexpr int kDivisions = 8;  // of a face's edge
  MeridianPoints points;
  for (int f = 0; f < mesh.boundary_faces.cols(); ++f) {
    for (int i = 0; i <= kDivisions; ++i) {
      for (int j = 0; j <= kDivisions - i; ++j) {
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
        points.emplace_back(p.head<2>().norm(), p.z());
      }
    }
  }
  return points;
}

/// Largest distance from a point of `points` to the polygon line through `line`. [m]
inline double FarthestFromLine(const MeridianPoints& points, const MeridianPoints& line) {
  double farthest = 0.0;
  for (const Eigen::Vector2d& p : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const Eigen::Vector2d edge = line[k + 1] - line[k];
      const double t =
          std::clamp((p - line[k]).dot(edge) / std::max(edge.squaredNorm(), 1e-30), 0.0, 1.0);
      nearest = std::min(nearest, (p - line[k] - t * edge).norm());
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

/// Largest distance from a point of `points` to the nearest of `others`. [m]
inline double FarthestFromPoints(const MeridianPoints& points, const MeridianPoints& others) {
  double farthest = 0.0;
  for (const Eigen::Vector2d& p : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& q : others) nearest = std::min(nearest, (p - q).squaredNorm());
    farthest = std::max(farthest, std::sqrt(nearest));
  }
  return farthest;
}

}  // namespace vacuum_gripper_sim
