#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace vacuum_gripper_sim {

/** A suction cup at rest: a volume of 4- or 10-node tetrahedra and the named parts of its boundary.

 Rest frame, as in a cup's mesh file: z is the cup's axis, the opening faces -z and the lip's lowest
 point lies at z = 0, all lengths in metres.

 Node order of an element is that of VTK: the corners 0 1 2 3 with
 (x1 - x0) x (x2 - x0) . (x3 - x0) > 0, then the mid-edge nodes of 01, 12, 20, 03, 13, 23.
 Node order of a face: the corners 0 1 2, counter-clockwise seen from outside the material, then the
 mid-edge nodes of 01, 12, 20. */
struct TetMesh {
  std::string source;              ///< Where it came from (a file name), for messages.
  Eigen::Matrix3Xd nodes;          ///< Rest positions, 3 by #nodes. [m]
  Eigen::MatrixXi elements;        ///< 4 or 10 by #elements; node indices.
  Eigen::MatrixXi boundary_faces;  ///< 3 or 6 by #faces; the whole boundary, oriented outwards.
  Eigen::MatrixXi cavity_faces;    ///< 3 or 6 by #faces; group `cavity`, oriented outwards.
  std::vector<int> mount_nodes;    ///< Group `mount`, sorted, unique: the clamped nodes.

  int num_nodes() const { return static_cast<int>(nodes.cols()); }
  int num_elements() const { return static_cast<int>(elements.cols()); }
  bool quadratic() const { return elements.rows() == 10; }
};

/** Builds a TetMesh from raw connectivity and checks all that the simulation relies on.

 Orients every face outwards (whatever the input's winding), finds the boundary, turns the nodes of
 elements with negative volume only if *all* are negative (a mirrored convention), and refuses:
 an empty mesh, non-finite nodes, elements that name unknown nodes, elements whose Jacobian is not
 positive at every corner and integration point (inverted, degenerate or over-curved), nodes no
 element uses, group faces that are not on the boundary, an empty `mount` or `cavity`, and a mesh
 wider than 1 m (a file in millimetres).

 @param source       Name for messages.
 @param nodes        3 by #nodes. [m]
 @param elements     4 or 10 by #elements, VTK order.
 @param cavity_faces 3 or 6 by #faces, any winding.
 @param mount_faces  3 or 6 by #faces, any winding.
 @throws std::invalid_argument naming source, element or node, its value and what is allowed. */
TetMesh MakeTetMesh(std::string source, Eigen::Matrix3Xd nodes, Eigen::MatrixXi elements,
                    const Eigen::MatrixXi& cavity_faces, const Eigen::MatrixXi& mount_faces);

/// Boundary faces as triangles: each 6-node face becomes four, wound as the face. 3-node faces
/// stay.
/// @param faces 3 or 6 by #faces. @returns 3 by #triangles.
Eigen::Matrix3Xi SplitFaces(const Eigen::MatrixXi& faces);

}  // namespace vacuum_gripper_sim
