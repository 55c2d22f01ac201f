#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace vacuum_gripper_sim {

/// Where on a triangle something is.
struct TrianglePoint {
  Eigen::Vector3d weights;       ///< Barycentric, >= 0, sum 1; exactly 0 off an edge or a corner.
  double squared_distance{0.0};  ///< From the point asked for. [m^2]
};

/** The point of triangle abc that is nearest to p: on the face, an edge or a corner, whichever's
 Voronoi region p is in. [Ericson, "Real-Time Collision Detection", 2005, Sec. 5.1.5] */
TrianglePoint NearestOnTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c, const Eigen::Vector3d& p);

/** Which triangles of a surface share sides and corners. Side k of a triangle runs from its corner
 k to the next one. */
struct TriangleTopology {
  static constexpr int kNone = -1;

  TriangleTopology() = default;
  /// @param triangles 3 by #F, indices 0 .. num_vertices - 1, consistently wound.
  TriangleTopology(const Eigen::Matrix3Xi& triangles, int num_vertices);

  /// 3 by #F: the triangle across each side; kNone at a border, and where more than two meet.
  Eigen::Matrix3Xi neighbors;
  std::vector<int> corners_begin;  ///< #V + 1: where a vertex's corners begin in `corners`.
  std::vector<int> corners;        ///< 3 t + k for corner k of triangle t, by vertex.
};

/// The angle of triangle t at its corner k. [rad]
double CornerAngle(const Eigen::Matrix3Xi& triangles, const Eigen::Matrix3Xd& vertices, int t,
                   int k);

/// Unit normal by the winding; zero if the triangle is flat.
Eigen::Vector3d TriangleNormal(const Eigen::Matrix3Xi& triangles, const Eigen::Matrix3Xd& vertices,
                               int t);

/** The normal whose sign with p - c says on which side of a surface a point p is, c being its
 nearest point: of the face; on an edge the sum of both faces' normals; at a corner the sum of all,
 weighted by their angles there. Not of unit length. [J. A. Baerentzen, H. Aanaes, "Signed Distance
 Computation Using the Angle Weighted Pseudonormal", IEEE TVCG 11(3), 2005]
 @param t Triangle with the nearest point. @param weights Of the nearest point.
 @param normal_of Unit normal of a triangle, by its index; zero for a flat one. */
template <typename NormalOf>
Eigen::Vector3d Pseudonormal(const Eigen::Matrix3Xi& triangles, const Eigen::Matrix3Xd& vertices,
                             const TriangleTopology& topology, int t,
                             const Eigen::Vector3d& weights, const NormalOf& normal_of) {
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  const auto around = [&](int vertex, const auto& visit) {
    const int end = topology.corners_begin[index(vertex) + 1];
    for (int i = topology.corners_begin[index(vertex)]; i < end; ++i) {
      visit(topology.corners[index(i)] / 3, topology.corners[index(i)] % 3);
    }
  };
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    if (weights((k + 1) % 3) != 0.0 || weights((k + 2) % 3) != 0.0) continue;
    around(triangles(k, t), [&](int other, int corner) {
      normal += CornerAngle(triangles, vertices, other, corner) * normal_of(other);
    });
    return normal;
  }
  for (int k = 0; k < 3; ++k) {
    if (weights((k + 2) % 3) != 0.0) continue;  // not on the side from k to k + 1
    const int neighbor = topology.neighbors(k, t);
    if (neighbor != TriangleTopology::kNone) return normal_of(t) + normal_of(neighbor);
    const int end = triangles((k + 1) % 3, t);
    around(triangles(k, t), [&](int other, int) {
      if ((triangles.col(other).array() == end).any()) normal += normal_of(other);
    });
    return normal;
  }
  return normal_of(t);
}

}  // namespace vacuum_gripper_sim
