#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "vacuum_gripper_sim/core/box_tree.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"
#include "vacuum_gripper_sim/core/triangle_geometry.h"

namespace vacuum_gripper_sim {

/// A point of the cup's boundary, as another point sees it.
struct CupFacePoint {
  int face{0};               ///< Index of the triangle, 0 .. num_faces() - 1.
  std::array<int, 3> nodes;  ///< Its mesh nodes, counter-clockwise seen from outside the material.
  Eigen::Vector3d weights;   ///< Barycentric, >= 0, sum 1: point = sum of weights(k) x(nodes[k]).
  double distance{0.0};      ///< Signed; positive outside the cup's material. [m]
  Eigen::Vector3d normal_W;  ///< Unit gradient of the distance: out of the material.
  Eigen::Vector3d position_W;  ///< Of the boundary's point. [m]
};

/** The boundary of the deformed cup as triangles, in a tree that follows the deformation.

 A 6-node face counts as four triangles, as everywhere else (CavitySurface): all of a triangle's
 corners are nodes, and so degrees of freedom.

 Signs are those of the angle-weighted pseudonormal (see Pseudonormal()), evaluated for the nearest
 point alone. A point deep in the material is nearest to some face, too, with a negative distance: a
 node of one wall of the cup sees the other side of the same wall at minus its thickness. Who looks
 for contacts between folds has to leave those faces out by `wanted`, for instance by what was
 behind what at rest. */
class CupFaces {
 public:
  /// At rest: positions are those of mesh.nodes until Update().
  explicit CupFaces(const TetMesh& mesh);

  /// Moves the boundary. @param x_W Positions of all mesh nodes, 3 by #nodes. [m]
  void Update(const Eigen::Matrix3Xd& x_W);

  int num_faces() const { return static_cast<int>(triangles_.cols()); }
  /// 3 by num_faces(): mesh nodes, counter-clockwise seen from outside the material.
  const Eigen::Matrix3Xi& triangles() const { return triangles_; }
  /// Of the whole boundary. [m]
  const Eigen::AlignedBox3d& bounds_W() const { return tree_.bounds(); }

  /** The point of the boundary that is nearest to p_W.
   @param max_distance Nothing farther than this is looked for, on either side. [m]
   @returns nothing if there is none within max_distance. */
  std::optional<CupFacePoint> Nearest(const Eigen::Vector3d& p_W, double max_distance) const {
    return Nearest(p_W, max_distance, [](int) { return true; });
  }

  /** The same among some faces alone.
   @param wanted Called with a face's index; faces for which it is false are skipped. */
  template <typename Predicate>
  std::optional<CupFacePoint> Nearest(const Eigen::Vector3d& p_W, double max_distance,
                                      const Predicate& wanted) const {
    Candidate best;
    best.at.squared_distance = max_distance * max_distance;
    tree_.VisitNear(p_W, &best.at.squared_distance, [&](int face) {
      if (wanted(face)) Consider(face, p_W, &best);
    });
    if (best.face < 0) return std::nullopt;
    return Describe(best, p_W);
  }

  /// The nearest point of one face.
  CupFacePoint On(int face, const Eigen::Vector3d& p_W) const;

 private:
  struct Candidate {
    int face{-1};
    TrianglePoint at;
  };

  void FitBoxes();
  void Consider(int face, const Eigen::Vector3d& p_W, Candidate* best) const;
  CupFacePoint Describe(const Candidate& nearest, const Eigen::Vector3d& p_W) const;

  Eigen::Matrix3Xi triangles_;
  TriangleTopology topology_;
  Eigen::Matrix3Xd x_W_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // of the triangles
  BoxTree tree_;
};

}  // namespace vacuum_gripper_sim
