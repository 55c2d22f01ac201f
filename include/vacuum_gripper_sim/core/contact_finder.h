#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "vacuum_gripper_sim/core/body_contacts.h"
#include "vacuum_gripper_sim/core/contact.h"
#include "vacuum_gripper_sim/core/face_contacts.h"
#include "vacuum_gripper_sim/core/rigid_world.h"

namespace vacuum_gripper_sim {

/** Two points that may not pass each other: one of the cup or of a rigid object, the other of an
 object. Its gap changes by

     d(gap) = n . (sum_k w_k dx_k + dp_other - dp_object),

 x_k being nodes of the cup, none for two objects. */
struct Contact {
  std::uint64_t key{0};  ///< The same for the same two things in the next step.
  int num_nodes{0};
  std::array<int, 4> nodes{};                       ///< Of the cup; the first `num_nodes` count.
  std::array<double, 4> weights{};                  ///< w. [-]
  int object{RigidWorld::kNone};                    ///< The normal points out of it.
  int other{RigidWorld::kNone};                     ///< What touches it in the cup's place.
  Eigen::Vector3d p_W{Eigen::Vector3d::Zero()};     ///< Where, when the step begins. [m]
  Eigen::Vector3d normal{Eigen::Vector3d::Zero()};  ///< World axes.
  Eigen::Vector3d across{
      Eigen::Vector3d::Zero()};  ///< Some direction across it, the same all step.
  double gap{0.0};               ///< < 0: penetrating. [m]
  Eigen::Vector3d slip_W{
      Eigen::Vector3d::Zero()};  ///< Of the one over the other since the step began. [m]
  double friction{0.0};          ///< Coulomb's mu. [-]
};

/// The end of a step as a trial has it.
struct TrialEnd {
  Eigen::Matrix3Xd x_W;                                ///< All nodes, 3 by #nodes. [m]
  Eigen::VectorXd dV;                                  ///< Of the free bodies, 6 #bodies.
  const std::vector<RigidSurface>* surfaces{nullptr};  ///< Where they are then, in the world.
};

/** Finds what touches: the cup's nodes and the objects, the objects' edges and the cup's faces, the
 cup's folds, the objects among each other.

 Gaps are measured along the normal seen when the step begins (Ahead), see NarrowPhase, or anew
 where a trial ends (At). Folds slide without friction; that between two objects is the geometric
 mean of theirs. */
class ContactFinder {
 public:
  /// @param mesh The cup at rest. @param nodes To be measured, ascending.
  /// @param may_touch Which of them objects may touch.
  ContactFinder(const TetMesh& mesh, std::vector<int> nodes, std::vector<bool> may_touch)
      : nodes_(std::move(nodes)), may_touch_(std::move(may_touch)), face_contacts_(mesh) {}

  /// Forgets what the last step saw, as when there are other objects.
  void Forget() {
    narrow_phase_.Forget();
    face_contacts_.Forget();
    body_contacts_.Forget();
  }

  /// Starts a step. @param world Must outlive it. @param x0_W All nodes, 3 by #nodes. [m]
  /// @param h Time step. [s]
  void Begin(const RigidWorld& world, const Eigen::Matrix3Xd& x0_W, double h);

  /// The contacts, as seen ahead, of which `wanted(key, gap)` is true; in an order that depends on
  /// nothing else. @param[out] contacts
  template <typename Predicate>
  void Select(const TrialEnd& end, const Predicate& wanted, std::vector<Contact>* contacts) const {
    contacts->clear();
    for (int i = 0; i < narrow_phase_.num_pairs(); ++i) {
      if (!may_touch_[PlaceOf(i)]) continue;
      if (wanted(NodeKey(i), NodeGap(i, end))) contacts->push_back(Ahead(NodeKey(i), end));
    }
    for (const FaceContacts::Pair& pair : face_contacts_.pairs()) {
      if (!GivesWay(pair, pair.seen)) continue;
      if (wanted(FaceKey(pair), FaceGap(pair, end))) contacts->push_back(Ahead(FaceKey(pair), end));
    }
    for (const FoldContact& fold : face_contacts_.folds()) {
      if (wanted(FoldKey(fold), FoldGap(fold, end))) contacts->push_back(Ahead(FoldKey(fold), end));
    }
    for (const BodyContacts::Pair& pair : body_contacts_.pairs()) {
      if (wanted(BodyKey(pair), BodyGap(pair, end))) contacts->push_back(Ahead(BodyKey(pair), end));
    }
  }

  /// Is what an earlier step called by this key still near enough for Ahead() and At()?
  bool Sees(std::uint64_t key) const;
  Contact Ahead(std::uint64_t key, const TrialEnd& end) const;
  Contact At(std::uint64_t key, const TrialEnd& end);

  /// Before At() and Nearest() of another trial.
  void MoveTo(const TrialEnd& end) {
    if (!face_contacts_.pairs().empty() || !face_contacts_.folds().empty()) {
      face_contacts_.MoveTo(end.x_W);
    }
  }
  /// Of each node to the surface nearest to it at a trial's end; +inf without surfaces. [m]
  void Nearest(const TrialEnd& end, std::vector<double>* nearest) {
    narrow_phase_.Nearest(*end.surfaces, end.x_W, nearest);
  }
  /// The surface that is nearest to a node when the step begins.
  int NearestSurface(int node) const { return narrow_phase_.NearestSurface(node); }

 private:
  // A key is the pair's number in its detector, and which one that is.
  static constexpr std::uint64_t kFaceKeys = std::uint64_t{1} << 40;
  static constexpr std::uint64_t kFoldKeys = std::uint64_t{2} << 40;
  static constexpr std::uint64_t kBodyKeys = std::uint64_t{3} << 40;
  static std::uint64_t NodeKey(int pair) { return static_cast<std::uint64_t>(pair); }
  static std::uint64_t FaceKey(const FaceContacts::Pair& pair) { return kFaceKeys + pair.id; }
  static std::uint64_t FoldKey(const FoldContact& fold) {
    return kFoldKeys + static_cast<std::uint64_t>(fold.node);
  }
  static std::uint64_t BodyKey(const BodyContacts::Pair& pair) { return kBodyKeys + pair.id; }

  std::size_t PlaceOf(int pair) const {
    return static_cast<std::size_t>(pair) / world_->surfaces().size();
  }
  bool GivesWay(const FaceContacts::Pair& pair, const CupFacePoint& seen) const;
  double NodeGap(int pair, const TrialEnd& end) const;
  double FaceGap(const FaceContacts::Pair& pair, const TrialEnd& end) const;
  double FoldGap(const FoldContact& fold, const TrialEnd& end) const;
  double BodyGap(const BodyContacts::Pair& pair, const TrialEnd& end) const;
  Contact NodeAgainst(int pair, const SurfaceDistance& seen, double gap, const TrialEnd& end) const;
  Contact FaceAgainst(const FaceContacts::Pair& pair, const CupFacePoint& seen, double gap,
                      const TrialEnd& end) const;
  Contact FoldAgainst(const FoldContact& fold, const FoldContact& seen, double gap) const;
  Contact BodyAgainst(const BodyContacts::Pair& pair, const SurfaceDistance& seen, double gap,
                      const TrialEnd& end) const;

  std::vector<int> nodes_;
  std::vector<bool> may_touch_;
  const RigidWorld* world_{nullptr};
  Eigen::Matrix3Xd x0_W_;
  double h_{0.0};
  NarrowPhase narrow_phase_;
  FaceContacts face_contacts_;
  BodyContacts body_contacts_;
};

}  // namespace vacuum_gripper_sim
