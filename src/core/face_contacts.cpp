#include "vacuum_gripper_sim/core/face_contacts.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace vacuum_gripper_sim {
namespace {

/// Of points along an edge: half the size of the lip's faces. Where a sharp edge of the cup crosses
/// one between two points, both pass each other by up to a sixth of it. [m]
constexpr double kSpacing = 5e-4;

/// Folds nearer than this may touch during a step. [m]
constexpr double kFoldReach = 5e-4;
/// How far nodes may move against each other before all of them look for folds again. [m]
constexpr double kFoldMargin = 1e-3;

/// Bound on how far any node moved against any other one. [m]
double RelativeMotion(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& x_before) {
  if (x.cols() != x_before.cols()) return std::numeric_limits<double>::infinity();
  Eigen::AlignedBox3d ways;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    ways.extend(Eigen::Vector3d(x.col(i) - x_before.col(i)));
  }
  return ways.diagonal().norm();
}

auto FindPlace(const std::vector<FaceContacts::Pair>& pairs, std::uint32_t id) {
  return std::lower_bound(
      pairs.begin(), pairs.end(), id,
      [](const FaceContacts::Pair& pair, std::uint32_t value) { return pair.id < value; });
}

auto FindPlace(const std::vector<FoldContact>& folds, int node) {
  return std::lower_bound(
      folds.begin(), folds.end(), node,
      [](const FoldContact& contact, int value) { return contact.node < value; });
}

}  // namespace

void FaceContacts::Begin(const RigidWorld& world, const Eigen::Matrix3Xd& x_W, double reach) {
  pairs_.clear();
  const std::vector<RigidSurface>& surfaces = world.surfaces();
  if (features_.size() != surfaces.size()) {
    features_.clear();
    for (const RigidSurface& surface : surfaces) {
      features_.push_back(SharpFeatures(surface.shape, kSpacing));
    }
  }
  FindFolds(x_W);
  const Eigen::AlignedBox3d around(Eigen::Vector3d(x_W.rowwise().minCoeff().array() - reach),
                                   Eigen::Vector3d(x_W.rowwise().maxCoeff().array() + reach));
  bool moved = false;
  std::uint32_t id = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (const FeaturePoint& feature : features_[i]) {
      const std::uint32_t this_id = id++;
      const Eigen::Vector3d p_W = surfaces[i].X_FS * feature.p_S;
      if (!around.contains(p_W)) continue;
      if (!moved) faces_.Update(x_W);
      moved = true;
      const std::optional<CupFacePoint> seen = faces_.Nearest(p_W, reach);
      if (seen) pairs_.push_back({this_id, static_cast<int>(i), p_W, *seen});
    }
  }
}

/// Only nodes that were near another fold look for it at every step.
void FaceContacts::FindFolds(const Eigen::Matrix3Xd& x_W) {
  const bool all = RelativeMotion(x_W, x_searched_) > kFoldMargin;
  if (all || !near_folds_.empty()) faces_.Update(x_W);
  if (all) {
    x_searched_ = x_W;
    near_folds_.clear();
    for (const FoldContact& fold : self_contact_.Find(faces_, x_W, kFoldReach + kFoldMargin)) {
      near_folds_.push_back(fold.node);
    }
  }
  self_contact_.Find(faces_, x_W, kFoldReach, near_folds_, &folds_);
}

bool FaceContacts::SeesFoldOf(int node) const {
  const auto place = FindPlace(folds_, node);
  return place != folds_.end() && place->node == node;
}

const FoldContact& FaceContacts::FoldOf(int node) const { return *FindPlace(folds_, node); }

bool FaceContacts::Sees(std::uint32_t id) const {
  const auto place = FindPlace(pairs_, id);
  return place != pairs_.end() && place->id == id;
}

const FaceContacts::Pair& FaceContacts::Find(std::uint32_t id) const {
  return *FindPlace(pairs_, id);
}

}  // namespace vacuum_gripper_sim
