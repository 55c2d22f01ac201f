#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vacuum_gripper_sim/core/cup_faces.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// A node of the cup before another part of the cup's own boundary: a row
/// normal . (x_node - sum of weights(k) x_face[k]) >= 0.
struct FoldContact {
  int node{0};              ///< Mesh node.
  int triangle{0};          ///< Index of the face in CupFaces.
  std::array<int, 3> face;  ///< Its mesh nodes, counter-clockwise seen from outside.
  Eigen::Vector3d weights;  ///< Barycentric, of the point of the face that is nearest to the node.
  double gap{0.0};          ///< Signed distance; < 0: the node is behind the face. [m]
  Eigen::Vector3d normal;   ///< Unit; out of the face, world axes: d(gap)/d(x_node).
};

/** Finds where the folds of a cup meet: nodes of the boundary near faces of it that

 - are not theirs: at least kNeighborhood element edges away along the boundary, and
 - face them: outward normals enclose more than 90 degrees, by a margin.

 The wall's other side faces a node as well, at minus the wall's thickness. A face that has the node
 farther behind it than half the thickness of the node's own wall at rest is taken for that other
 side; folds that passed each other by more are no longer seen.

 Of all faces that a node may touch the nearest counts: one contact a node. Nothing depends on the
 past, so the same shape has the same contacts. Working memory is kept: one thread at a time. */
class SelfContact {
 public:
  /// Edges of elements between a node and the nearest face that it may touch. Fewer, and a
  /// fillet would touch itself; more, and a fold's root would pass itself.
  static constexpr int kNeighborhood = 2;

  /// @param faces Of this mesh, at rest.
  SelfContact(const TetMesh& mesh, const CupFaces& faces);

  /** The contacts nearer than a reach; clamped nodes touch nothing. Nodes ascending.
   @param faces Updated to x_W. @param x_W Positions of all mesh nodes, 3 by #nodes. [m]
   @param reach Largest gap. [m] */
  std::vector<FoldContact> Find(const CupFaces& faces, const Eigen::Matrix3Xd& x_W,
                                double reach) const {
    std::vector<FoldContact> contacts;
    Find(faces, x_W, reach, nodes_, &contacts);
    return contacts;
  }
  /// The same of some nodes alone. @param nodes Of the boundary, not clamped, ascending.
  /// @param[out] contacts
  void Find(const CupFaces& faces, const Eigen::Matrix3Xd& x_W, double reach,
            const std::vector<int>& nodes, std::vector<FoldContact>* contacts) const;

  /// The same node before the same face somewhere else. @param faces Updated to x_W.
  static FoldContact At(const FoldContact& contact, const CupFaces& faces,
                        const Eigen::Matrix3Xd& x_W);

  /// Half the thickness of the wall at a node of the boundary, at rest. [m]
  double half_wall(int node) const { return half_walls_[static_cast<std::size_t>(node)]; }

 private:
  /// Outward normals of the boundary.
  struct Normals {
    Eigen::Matrix3Xd of_triangles;  // unit, 3 by #triangles
    Eigen::Matrix3Xd of_nodes;      // means weighted by area, unit, 3 by #nodes; 0 inside
  };
  void FindNormals(const Eigen::Matrix3Xi& triangles, const Eigen::Matrix3Xd& x) const;
  bool MayTouch(std::size_t index, int triangle) const;

  std::vector<int> nodes_;                    // of the boundary, without the clamped, ascending
  std::vector<std::vector<int>> neighbours_;  // triangles next to each of nodes_, ascending
  std::vector<double> half_walls_;            // by mesh node; 0 inside the material [m]
  mutable Normals normals_;                   // of the shape at hand
};

}  // namespace vacuum_gripper_sim
