#include "vacuum_gripper_sim/core/face_contacts.h"

#include <algorithm>
#include <cstddef>

namespace vacuum_gripper_sim {
namespace {

/// Of points along an edge: half the size of the lip's faces. Where a sharp edge of the cup crosses
/// one between two points, both pass each other by up to a sixth of it. [m]
constexpr double kSpacing = 5e-4;

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
  faces_.Update(x_W);
  folds_ = self_contact_.Find(faces_, x_W, reach);
  const Eigen::AlignedBox3d around(Eigen::Vector3d(faces_.bounds_W().min().array() - reach),
                                   Eigen::Vector3d(faces_.bounds_W().max().array() + reach));
  std::uint32_t id = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (const FeaturePoint& feature : features_[i]) {
      const std::uint32_t this_id = id++;
      const Eigen::Vector3d p_W = surfaces[i].X_FS * feature.p_S;
      if (!around.contains(p_W)) continue;
      const std::optional<CupFacePoint> seen = faces_.Nearest(p_W, reach);
      if (seen) pairs_.push_back({this_id, static_cast<int>(i), p_W, *seen});
    }
  }
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
