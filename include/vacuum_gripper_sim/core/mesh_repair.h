#pragma once

#include <Eigen/Core>
#include <vector>

namespace vacuum_gripper_sim {

/// Triangles with their corners joined, wound alike, and the shells that they make up.
struct RepairedTriangles {
  Eigen::Matrix3Xd vertices;   ///< 3 by #V. [m]
  Eigen::Matrix3Xi triangles;  ///< 3 by #F, counter-clockwise seen from outside or the front.
  std::vector<bool> flat;      ///< #F: of no area; only there to join their neighbours.
  std::vector<int> shell;      ///< #F: which connected piece it belongs to, 0 .. #shells - 1.
  std::vector<bool> closed;    ///< #shells: encloses a volume.

  int merged_vertices{0};    ///< Vertices that lay on another one.
  int dropped_triangles{0};  ///< Had a corner twice, or were there twice.
  int turned_triangles{0};   ///< Were wound against their neighbours, or a whole shell inside out.
};

/** Makes a surface of what modelling tools and scanners write.

 Vertices nearer to each other than 1e-7 of the mesh's diagonal become one (STL files share none),
 triangles that lose a corner by it or have the same corners as another are dropped. Neighbours
 across a side are wound alike, the way that most of a connected piece's area was; where more than
 two triangles meet at a side, nothing is passed on. A shell is closed if every side is run through
 as often in one direction as in the other. A closed shell that is inside out is turned, unless it
 lies within the bounds of a larger one: then it is a void in it. Holes stay holes: their shell is
 open.

 @param triangles 3 by #F. @pre Indices are within the vertices, which are finite. */
RepairedTriangles RepairTriangles(const Eigen::Matrix3Xd& vertices,
                                  const Eigen::Matrix3Xi& triangles);

}  // namespace vacuum_gripper_sim
