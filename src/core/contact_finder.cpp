#include "vacuum_gripper_sim/core/contact_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vacuum_gripper_sim {
namespace {

/// Objects farther apart than this when a step begins do not meet during it. [m]
constexpr double kBodyReach = 0.02;
/// Edges farther from the cup than this do not meet it. [m]
constexpr double kFaceReach = 3e-3;
/// Share of a point of the cup's faces that has to be on nodes that are not clamped. [-]
constexpr double kLeastFreeWeight = 1e-3;

/// The axis that is most across a normal.
Eigen::Vector3d Across(const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  return Eigen::Vector3d::Unit(axis);
}

}  // namespace

void ContactFinder::Begin(const RigidWorld& world, const Eigen::Matrix3Xd& x0_W, double h) {
  world_ = &world;
  x0_W_ = x0_W;
  h_ = h;
  narrow_phase_.Begin(world.surfaces(), nodes_, x0_W);
  face_contacts_.Begin(world, x0_W, kFaceReach);
  body_contacts_.Begin(world, kBodyReach);
}

bool ContactFinder::Sees(std::uint64_t key) const {
  if (key < kFaceKeys) return true;
  if (key < kFoldKeys) return face_contacts_.Sees(static_cast<std::uint32_t>(key - kFaceKeys));
  if (key < kBodyKeys) return face_contacts_.SeesFoldOf(static_cast<int>(key - kFoldKeys));
  return body_contacts_.Sees(static_cast<std::uint32_t>(key - kBodyKeys));
}

/// Is there a motion that answers the contact? A fixed edge before a clamped part of the cup has
/// none.
bool ContactFinder::GivesWay(const FaceContacts::Pair& pair, const CupFacePoint& seen) const {
  if (world_->BodyOf(world_->ObjectOf(pair.surface)) != RigidWorld::kNone) return true;
  double free_weight = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto place =
        std::lower_bound(nodes_.begin(), nodes_.end(), seen.nodes[k]) - nodes_.begin();
    if (may_touch_[static_cast<std::size_t>(place)]) {
      free_weight += seen.weights(static_cast<Eigen::Index>(k));
    }
  }
  return free_weight > kLeastFreeWeight;
}

double ContactFinder::NodeGap(int pair, const TrialEnd& end) const {
  const double gap = narrow_phase_.Ahead(pair, end.x_W).gap;
  const int object = world_->ObjectOf(narrow_phase_.surface(pair));
  const SurfaceDistance& seen = narrow_phase_.seen(pair);
  const Eigen::Vector3d p_W = x0_W_.col(narrow_phase_.node(pair)) - seen.distance * seen.normal;
  return gap - seen.normal.dot(world_->FreeDisplacement(object, p_W, end.dV, h_));
}

double ContactFinder::FaceGap(const FaceContacts::Pair& pair, const TrialEnd& end) const {
  Eigen::Vector3d of_face_W = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const int node = pair.seen.nodes[static_cast<std::size_t>(k)];
    of_face_W += pair.seen.weights(k) * (end.x_W.col(node) - x0_W_.col(node));
  }
  const int object = world_->ObjectOf(pair.surface);
  const Eigen::Vector3d of_edge_W = world_->FreeDisplacement(object, pair.p_W, end.dV, h_);
  return pair.seen.distance + pair.seen.normal_W.dot(of_edge_W - of_face_W);
}

double ContactFinder::FoldGap(const FoldContact& fold, const TrialEnd& end) const {
  Eigen::Vector3d relative_W = end.x_W.col(fold.node) - x0_W_.col(fold.node);
  for (int k = 0; k < 3; ++k) {
    const int node = fold.face[static_cast<std::size_t>(k)];
    relative_W -= fold.weights(k) * (end.x_W.col(node) - x0_W_.col(node));
  }
  return fold.gap + fold.normal.dot(relative_W);
}

double ContactFinder::BodyGap(const BodyContacts::Pair& pair, const TrialEnd& end) const {
  const Eigen::Vector3d& n = pair.seen.normal;
  const Eigen::Vector3d p_W = pair.p_W - pair.radius * n;
  const Eigen::Vector3d q_W = p_W - pair.seen.distance * n;
  const int object = world_->ObjectOf(pair.surface);
  const auto moved = [&](int index, const Eigen::Vector3d& point_W) {
    return n.dot(world_->FreeDisplacement(index, point_W, end.dV, h_));
  };
  return pair.seen.distance + moved(world_->ObjectOf(pair.feeling), pair.p_W) - moved(object, q_W);
}

Contact ContactFinder::NodeAgainst(int pair, const SurfaceDistance& seen, double gap,
                                   const TrialEnd& end) const {
  const int node = narrow_phase_.node(pair);
  const int surface = narrow_phase_.surface(pair);
  const SurfaceDistance& start = narrow_phase_.seen(pair);
  Contact contact;
  contact.key = NodeKey(pair);
  contact.num_nodes = 1;
  contact.nodes[0] = node;
  contact.weights[0] = 1.0;
  contact.object = world_->ObjectOf(surface);
  contact.p_W = x0_W_.col(node) - start.distance * start.normal;
  contact.normal = seen.normal;
  contact.across = Across(start.normal);
  contact.gap = gap;
  contact.friction = world_->surfaces()[static_cast<std::size_t>(surface)].friction;
  if (contact.friction > 0.0) {
    contact.slip_W = end.x_W.col(node) - x0_W_.col(node) -
                     world_->Displacement(contact.object, contact.p_W, end.dV, h_);
  }
  return contact;
}

Contact ContactFinder::FaceAgainst(const FaceContacts::Pair& pair, const CupFacePoint& seen,
                                   double gap, const TrialEnd& end) const {
  Contact contact;
  contact.key = FaceKey(pair);
  contact.num_nodes = 3;
  Eigen::Vector3d of_face_W = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    contact.nodes[k] = seen.nodes[k];
    contact.weights[k] = seen.weights(static_cast<Eigen::Index>(k));
    of_face_W += contact.weights[k] * (end.x_W.col(seen.nodes[k]) - x0_W_.col(seen.nodes[k]));
  }
  contact.object = world_->ObjectOf(pair.surface);
  contact.p_W = pair.p_W;
  contact.normal = -seen.normal_W;
  contact.across = Across(pair.seen.normal_W);
  contact.gap = gap;
  contact.friction = world_->surfaces()[static_cast<std::size_t>(pair.surface)].friction;
  contact.slip_W = of_face_W - world_->Displacement(contact.object, pair.p_W, end.dV, h_);
  return contact;
}

/// @param fold As the step began. @param seen The same at the end.
Contact ContactFinder::FoldAgainst(const FoldContact& fold, const FoldContact& seen,
                                   double gap) const {
  Contact contact;
  contact.key = FoldKey(fold);
  contact.num_nodes = 4;
  contact.nodes[0] = fold.node;
  contact.weights[0] = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    contact.nodes[k + 1] = seen.face[k];
    contact.weights[k + 1] = -seen.weights(static_cast<Eigen::Index>(k));
  }
  contact.p_W = x0_W_.col(fold.node);
  contact.normal = seen.normal;
  contact.across = Across(fold.normal);
  contact.gap = gap;
  return contact;
}

Contact ContactFinder::BodyAgainst(const BodyContacts::Pair& pair, const SurfaceDistance& seen,
                                   double gap, const TrialEnd& end) const {
  Contact contact;
  contact.key = BodyKey(pair);
  contact.object = world_->ObjectOf(pair.surface);
  contact.other = world_->ObjectOf(pair.feeling);
  contact.p_W = pair.p_W - pair.radius * pair.seen.normal;
  contact.normal = seen.normal;
  contact.across = Across(pair.seen.normal);
  contact.gap = gap;
  const std::vector<RigidSurface>& surfaces = world_->surfaces();
  contact.friction = std::sqrt(surfaces[static_cast<std::size_t>(pair.feeling)].friction *
                               surfaces[static_cast<std::size_t>(pair.surface)].friction);
  contact.slip_W = world_->Displacement(contact.other, contact.p_W, end.dV, h_) -
                   world_->Displacement(contact.object, contact.p_W, end.dV, h_);
  return contact;
}

Contact ContactFinder::Ahead(std::uint64_t key, const TrialEnd& end) const {
  if (key >= kFoldKeys && key < kBodyKeys) {
    const FoldContact& fold = face_contacts_.FoldOf(static_cast<int>(key - kFoldKeys));
    return FoldAgainst(fold, fold, FoldGap(fold, end));
  }
  if (key >= kFaceKeys && key < kFoldKeys) {
    const FaceContacts::Pair& pair =
        face_contacts_.Find(static_cast<std::uint32_t>(key - kFaceKeys));
    return FaceAgainst(pair, pair.seen, FaceGap(pair, end), end);
  }
  if (key >= kBodyKeys) {
    const BodyContacts::Pair& pair =
        body_contacts_.Find(static_cast<std::uint32_t>(key - kBodyKeys));
    return BodyAgainst(pair, pair.seen, BodyGap(pair, end), end);
  }
  const auto pair = static_cast<int>(key);
  return NodeAgainst(pair, narrow_phase_.seen(pair), NodeGap(pair, end), end);
}

Contact ContactFinder::At(std::uint64_t key, const TrialEnd& end) {
  if (key >= kFoldKeys && key < kBodyKeys) {
    const FoldContact& fold = face_contacts_.FoldOf(static_cast<int>(key - kFoldKeys));
    const FoldContact seen = SelfContact::At(fold, face_contacts_.faces(), end.x_W);
    return FoldAgainst(fold, seen, seen.gap);
  }
  if (key >= kFaceKeys && key < kFoldKeys) {
    const FaceContacts::Pair& pair =
        face_contacts_.Find(static_cast<std::uint32_t>(key - kFaceKeys));
    const int object = world_->ObjectOf(pair.surface);
    const Eigen::Vector3d p_W = pair.p_W + world_->FreeDisplacement(object, pair.p_W, end.dV, h_);
    const std::optional<CupFacePoint> seen = face_contacts_.faces().Nearest(p_W, 2.0 * kFaceReach);
    if (seen && GivesWay(pair, *seen)) return FaceAgainst(pair, *seen, seen->distance, end);
    return FaceAgainst(pair, pair.seen, kFaceReach, end);
  }
  if (key >= kBodyKeys) {
    const BodyContacts::Pair& pair =
        body_contacts_.Find(static_cast<std::uint32_t>(key - kBodyKeys));
    const int other = world_->ObjectOf(pair.feeling);
    const Eigen::Vector3d p_W = pair.p_W + world_->FreeDisplacement(other, pair.p_W, end.dV, h_);
    const SurfaceDistance seen =
        body_contacts_.Look(pair, (*end.surfaces)[static_cast<std::size_t>(pair.surface)], p_W);
    return BodyAgainst(pair, seen, seen.distance - pair.radius, end);
  }
  const auto pair = static_cast<int>(key);
  const NodeContact there = narrow_phase_.At(pair, *end.surfaces, end.x_W);
  return NodeAgainst(pair, {there.gap, there.normal}, there.gap, end);
}

}  // namespace vacuum_gripper_sim
