#include "vacuum_gripper_sim/core/body_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "vacuum_gripper_sim/core/triangle_mesh.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

/// A point that feels, in the frame of its surface S.
struct Feeler {
  Vector3d p_S;
  double radius{0.0};
  Vector3d edge_S{Vector3d::Zero()};  ///< Direction of the edge inside which it is; zero: none.
  bool absent{false};                 ///< Keeps its number, but does not feel.
};

constexpr int kPointsAlongAnEdge = 3;  // between its corners
constexpr int kPointsAlongARim = 8;    // besides the deepest one
/// Sine of the angle to a surface below which an edge is carried by its ends, and a rim all round.
/// More points than needed would share the load in more ways than one.
constexpr double kFlat = 0.05;

// Calls f(feeler) on all of a shape. How many there are does not depend on `into`: their numbers
// name them from step to step.
// @param into Direction, in S, in which the other surface lies.

template <typename Function>
void ForFeelers(const Plane&, const Vector3d& /*into*/, const Function& /*f*/) {}

template <typename Function>
void ForFeelers(const Sphere& sphere, const Vector3d& /*into*/, const Function& f) {
  Feeler feeler;
  feeler.p_S.setZero();
  feeler.radius = sphere.radius;
  f(feeler);
}

template <typename Function>
void ForFeelers(const Box& box, const Vector3d& /*into*/, const Function& f) {
  const Vector3d half = 0.5 * box.size;
  for (int along = 0; along < 3; ++along) {
    for (int side = 0; side < 4; ++side) {
      Vector3d p = half;
      if ((side & 1) != 0) p((along + 1) % 3) *= -1.0;
      if ((side & 2) != 0) p((along + 2) % 3) *= -1.0;
      // Corners belong to the edges along x.
      const int first = along == 0 ? 0 : 1;
      const int last = kPointsAlongAnEdge + (along == 0 ? 1 : 0);
      for (int i = first; i <= last; ++i) {
        p(along) = half(along) * (2.0 * i / (kPointsAlongAnEdge + 1) - 1.0);
        const bool inside = i > 0 && i <= kPointsAlongAnEdge;
        f(Feeler{p, 0.0, inside ? Vector3d::Unit(along) : Vector3d::Zero().eval()});
      }
    }
  }
}

template <typename Function>
void ForFeelers(const Cylinder& cylinder, const Vector3d& into, const Function& f) {
  const double deepest = std::atan2(into.y(), into.x());
  for (const double side : {-0.5, 0.5}) {
    for (int i = -1; i < kPointsAlongARim; ++i) {
      const double angle = i < 0 ? deepest : 2.0 * M_PI * i / kPointsAlongARim;
      Feeler feeler;
      feeler.p_S << cylinder.radius * std::cos(angle), cylinder.radius * std::sin(angle),
          side * cylinder.length;
      feeler.absent = i < 0 && into.head<2>().norm() < kFlat;  // the deepest is any of them
      f(feeler);
    }
  }
}

template <typename Function>
void ForFeelers(const Mesh& mesh, const Vector3d& /*into*/, const Function& f) {
  for (Eigen::Index i = 0; i < mesh->vertices().cols(); ++i) {
    Feeler feeler;
    feeler.p_S = mesh->vertices().col(i);
    f(feeler);
  }
}

auto FindPlace(const std::vector<BodyContacts::Pair>& pairs, std::uint32_t id) {
  return std::lower_bound(
      pairs.begin(), pairs.end(), id,
      [](const BodyContacts::Pair& pair, std::uint32_t value) { return pair.id < value; });
}

}  // namespace

void BodyContacts::Begin(const RigidWorld& world, double reach) {
  pairs_.clear();
  if (world.num_bodies() == 0) return;
  const std::vector<RigidSurface>& surfaces = world.surfaces();
  const auto num_surfaces = static_cast<int>(surfaces.size());
  std::uint32_t id = 0;
  for (int i = 0; i < num_surfaces; ++i) {
    const RigidSurface& felt_out = surfaces[static_cast<std::size_t>(i)];
    const int other = world.ObjectOf(i);
    for (int surface = 0; surface < num_surfaces; ++surface) {
      const int object = world.ObjectOf(surface);
      if (object == other ||
          (world.BodyOf(object) == RigidWorld::kNone && world.BodyOf(other) == RigidWorld::kNone)) {
        continue;
      }
      const RigidSurface& against = surfaces[static_cast<std::size_t>(surface)];
      const Vector3d into_W = -Distance(against, felt_out.X_FS.translation()).normal;
      const Vector3d into = felt_out.X_FS.linear().transpose() * into_W;
      const auto look = [&](const Feeler& feeler) {
        Pair pair;
        pair.id = id++;
        if (feeler.absent) return;
        pair.feeling = i;
        pair.surface = surface;
        pair.p_W = felt_out.X_FS * feeler.p_S;
        pair.radius = feeler.radius;
        // A sphere sees as far as its middle is from what it touches.
        pair.seen = std::holds_alternative<Mesh>(against.shape)
                        ? sightings_[pair.id].BeginStep(against, pair.p_W, reach + pair.radius)
                        : Distance(against, pair.p_W);
        pair.seen.distance -= feeler.radius;
        if (pair.seen.distance >= reach) return;
        const Vector3d edge_W = felt_out.X_FS.linear() * feeler.edge_S;
        const bool carried_by_its_ends =
            !feeler.edge_S.isZero(0.0) && std::abs(pair.seen.normal.dot(edge_W)) < kFlat;
        if (!carried_by_its_ends) pairs_.push_back(pair);
      };
      std::visit([&](const auto& shape) { ForFeelers(shape, into, look); }, felt_out.shape);
    }
  }
}

SurfaceDistance BodyContacts::Look(const Pair& pair, const RigidSurface& surface,
                                   const Eigen::Vector3d& p_W) {
  return std::holds_alternative<Mesh>(surface.shape) ? sightings_[pair.id].Look(surface, p_W)
                                                     : Distance(surface, p_W);
}

bool BodyContacts::Sees(std::uint32_t id) const {
  const auto place = FindPlace(pairs_, id);
  return place != pairs_.end() && place->id == id;
}

const BodyContacts::Pair& BodyContacts::Find(std::uint32_t id) const {
  return *FindPlace(pairs_, id);
}

}  // namespace vacuum_gripper_sim
