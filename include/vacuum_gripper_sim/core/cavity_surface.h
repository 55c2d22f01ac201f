#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/** The inner surface C of the cup as the classifier sees it ([Bernardin, Sec. III-B]): points, the
 triangles between them, the vertex graph, the border ring B and the port.

 Every mesh node of the group `cavity` is a point, mid-edge nodes included: a 6-node face counts as
 four linear triangles, so that a seal can run between corner nodes, which carry no load under a
 uniform pressure on quadratic faces. Points are numbered 0 .. num_points()-1.

 Triangles are counter-clockwise seen from within the material, so that their area vectors point out
 of the cavity's air into the material: a gauge pressure p pushes on the material with p times them,
 which makes them the pressure row H_p of [Bernardin, Sec. III-C]. */
struct CavitySurface {
  std::vector<int> nodes;                    ///< Mesh node of each point, ascending.
  Eigen::Matrix3Xi triangles;                ///< 3 by #triangles; point indices.
  std::vector<std::vector<int>> neighbours;  ///< Vertex graph: the points one edge away, ascending.
  std::vector<int> border;  ///< B: the points on the surface's one boundary loop, ascending.
  std::vector<int> port;    ///< Where the vacuum enters: of each cup the point nearest to its axis.
  /// Where the points of each cup begin, and num_points(): a gripper's cups have one surface each,
  /// numbered one after the other, no edge between them.
  std::vector<int> first_points{0};

  int num_points() const { return static_cast<int>(nodes.size()); }
  int num_cups() const { return static_cast<int>(first_points.size()) - 1; }
};

/** Builds the cavity surface of a mesh of one cup.

 The port is the point nearest to the cup's axis (x = y = 0); of several equally near ones, the
 highest.

 @throws std::invalid_argument when the surface is not a connected manifold with exactly one
   boundary loop (the rim): names the source, the edge and the reason. */
CavitySurface MakeCavitySurface(const TetMesh& mesh);

/** Area vectors of the surface's dual cells: for every point the sum over its triangles of
 (area vector) / 3, pointing out of the cavity into the material. [Bernardin, Sec. III-C]

 @param x_W Positions of all mesh nodes, 3 by #nodes. [m]
 @param[out] areas 3 by num_points(). [m^2] */
void PointAreaVectors(const CavitySurface& surface, const Eigen::Matrix3Xd& x_W,
                      Eigen::Matrix3Xd* areas);
Eigen::Matrix3Xd PointAreaVectors(const CavitySurface& surface, const Eigen::Matrix3Xd& x_W);

}  // namespace vacuum_gripper_sim
