#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "vacuum_gripper_sim/core/cup_faces.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/self_contact.h"
#include "vacuum_gripper_sim/core/surface_features.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/** What touches the cup's faces: sharp edges and corners of objects, which would otherwise poke
 through the wall between its nodes, and other folds of the cup. */
class FaceContacts {
 public:
  /// A point of an edge before the face of the cup that is nearest to it.
  struct Pair {
    std::uint32_t id{0};  ///< The same in the next step.
    int surface{0};       ///< That has the edge.
    Eigen::Vector3d p_W;  ///< The point, when the step begins. [m]
    CupFacePoint seen;    ///< From there.
  };

  explicit FaceContacts(const TetMesh& mesh) : faces_(mesh), self_contact_(mesh, faces_) {}

  /// Starts a step. @param x_W All nodes, 3 by #nodes. [m]
  /// @param reach Points farther from the cup are left out. [m]
  void Begin(const RigidWorld& world, const Eigen::Matrix3Xd& x_W, double reach);
  /// Forgets the edges of the surfaces, as when there are others.
  void Forget() { features_.clear(); }

  /// With ascending ids.
  const std::vector<Pair>& pairs() const { return pairs_; }
  bool Sees(std::uint32_t id) const;
  /// @pre Sees(id).
  const Pair& Find(std::uint32_t id) const;
  /// Nodes before other folds, ascending.
  const std::vector<FoldContact>& folds() const { return folds_; }
  bool SeesFoldOf(int node) const;
  /// @pre SeesFoldOf(node).
  const FoldContact& FoldOf(int node) const;

  /// The boundary of the cup, where Begin() or MoveTo() saw it last.
  const CupFaces& faces() const { return faces_; }
  /// Moves the boundary to a trial's end.
  void MoveTo(const Eigen::Matrix3Xd& x_W) { faces_.Update(x_W); }

 private:
  void FindFolds(const Eigen::Matrix3Xd& x_W);

  std::vector<std::vector<FeaturePoint>> features_;  // by surface
  CupFaces faces_;
  std::vector<Pair> pairs_;
  SelfContact self_contact_;
  std::vector<FoldContact> folds_;
  Eigen::Matrix3Xd x_searched_;  // where all nodes were when they looked for folds last
  std::vector<int> near_folds_;  // nodes that may touch one until they do so again
};

}  // namespace vacuum_gripper_sim
