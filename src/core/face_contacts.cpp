#include "vacuum_gripper_sim/core/face_contacts.h"

#include <algorithm>
#include <cstddef>

namespace vacuum_gripper_sim {
namespace {

/// Of points along an edge: about the size of the lip's faces. [m]
constexpr double kSpacing = 1e-3;

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

const FoldContact& FaceContacts::FoldOf(int node) const {
  return *std::lower_bound(
      folds_.begin(), folds_.end(), node,
      [](const FoldContact& contact, int value) { return contact.node < value; });
}

const FaceContacts::Pair& FaceContacts::Find(std::uint32_t id) const {
  return *std::lower_bound(pairs_.begin(), pairs_.end(), id,
                           [](const Pair& pair, std::uint32_t value) { return pair.id < value; });
}

}  // namespace vacuum_gripper_sim
