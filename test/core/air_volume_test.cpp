#include "vacuum_gripper_sim/core/air_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_surface.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.015;  // of the wet part [m]
constexpr double kDome = 0.009;    // its height [m]
const Vector3d kDown = -Vector3d::UnitZ();

/// Rings about the z axis with the heights of a profile, wet as far as kRadius; two more are dry.
struct RingPatch {
  static constexpr int kAround = 120, kRings = 60;

  explicit RingPatch(const std::function<double(double)>& height) {
    TetMesh mesh;
    mesh.source = "drawn.msh";
    mesh.nodes.resize(3, 1 + (kRings + 2) * kAround);
    mesh.nodes.col(0) << 0.0, 0.0, height(0.0);
    mesh.cavity_faces.resize(3, kAround * (1 + 2 * (kRings + 1)));
    int face = 0;
    for (int ring = 1; ring <= kRings + 2; ++ring) {
      const double radius = kRadius * ring / kRings;
      for (int k = 0; k < kAround; ++k) {
        const double azimuth = 2.0 * M_PI * k / kAround;
        mesh.nodes.col(Node(ring, k)) << radius * std::cos(azimuth), radius * std::sin(azimuth),
            height(radius);
        // Seen from below, out of the material: clockwise from above.
        if (ring == 1) {
          mesh.cavity_faces.col(face++) << 0, Node(1, k + 1), Node(1, k);
        } else {
          mesh.cavity_faces.col(face++) << Node(ring - 1, k), Node(ring, k + 1), Node(ring, k);
          mesh.cavity_faces.col(face++) << Node(ring - 1, k), Node(ring - 1, k + 1),
              Node(ring, k + 1);
        }
      }
    }
    surface = MakeCavitySurface(mesh);
    surface.first_points = {0, surface.num_points()};
    nodes = mesh.nodes;
    for (int i = 0; i < nodes.cols(); ++i) wet.push_back(i < Node(kRings + 1, 0));
  }
  static int Node(int ring, int k) {
    return ring == 0 ? 0 : 1 + (ring - 1) * kAround + k % kAround;
  }

  Eigen::Matrix3Xd areas() const { return PointAreaVectors(surface, nodes); }
  double Air(const std::function<double(const Vector3d&)>& distance) const {
    return AirVolume(surface, 0, wet, nodes, areas(), kDown, distance);
  }
  double AirOver(const RigidSurface& object) const {
    return Air([&](const Vector3d& p) { return Distance(object, p).distance; });
  }

  CavitySurface surface;
  Eigen::Matrix3Xd nodes;  // [m]
  std::vector<bool> wet;
};

double Paraboloid(double r) { return kDome * std::max(1.0 - r * r / (kRadius * kRadius), 0.0); }
/// Under it, above the height z.
double ParaboloidVolume(double z) {
  return 0.5 * M_PI * kRadius * kRadius * (kDome - z) * (kDome - z) / kDome;
}

TEST(AirVolume, EndsAtTheMouthWhereNothingIsBeforeTheCup) {
  const RingPatch dome(Paraboloid);
  const double volume = ParaboloidVolume(0.0);
  EXPECT_NEAR(dome.Air([](const Vector3d&) { return std::numeric_limits<double>::infinity(); }),
              volume, 5e-3 * volume);
}

TEST(AirVolume, EndsAtAPlaneThatReachesIntoTheCup) {
  const RingPatch dome(Paraboloid);
  for (const double height : {-0.001, 0.0, 0.002, 0.005}) {
    RigidSurface plane{"plane", Plane{}};
    plane.X_FS.translation().z() = height;
    const double volume = ParaboloidVolume(std::max(height, 0.0));
    EXPECT_NEAR(dome.AirOver(plane), volume, 5e-3 * ParaboloidVolume(0.0)) << height;
  }
}

TEST(AirVolume, ASphereAndABoxTakeTheirOwnVolumeAway) {
  const RingPatch dome(Paraboloid);
  RigidSurface sphere{"sphere", Sphere{0.006}};
  sphere.X_FS.translation().z() = -0.002;  // 4 mm of it stand in the cup
  const double cap = M_PI * 0.004 * 0.004 * (0.006 - 0.004 / 3.0);
  const double whole = ParaboloidVolume(0.0);
  EXPECT_NEAR(dome.AirOver(sphere), whole - cap, 5e-3 * whole);

  RigidSurface box{"box", Box{{0.010, 0.010, 0.010}}};
  box.X_FS.translation().z() = -0.001;  // 4 mm
  EXPECT_NEAR(dome.AirOver(box), whole - 0.010 * 0.010 * 0.004, 1e-2 * whole);
}

TEST(AirVolume, IsNoneWithoutAMouth) {
  RingPatch dome(Paraboloid);
  std::fill(dome.wet.begin(), dome.wet.end(), false);
  EXPECT_EQ(dome.AirOver({"plane", Plane{}}), 0.0);
}

double Swept(const RingPatch& from, const RingPatch& to, const std::vector<bool>& wet) {
  return SweptVolume(from.surface, 0, wet, to.nodes - from.nodes, from.areas(), to.areas());
}

TEST(SweptVolume, IsWhatTheAirUnderTheCupBecomesMore) {
  const RigidSurface plane{"plane", Plane{}};
  const RingPatch before(Paraboloid);
  RingPatch after([](double r) { return 1.3 * Paraboloid(r); });
  const double grown = 0.3 * ParaboloidVolume(0.0);
  EXPECT_NEAR(Swept(before, after, before.wet), grown, 5e-3 * grown);
  EXPECT_NEAR(Swept(before, after, before.wet), after.AirOver(plane) - before.AirOver(plane),
              1e-4 * grown);
  // Wider too, by 4 %: the volume by 4 % squared more; the mean of the areas is exact to the
  // second order of what the points move.
  after.nodes.topRows<2>() *= 1.04;
  const double wider = (1.3 * 1.04 * 1.04 - 1.0) * ParaboloidVolume(0.0);
  EXPECT_NEAR(Swept(before, after, before.wet), wider, 5e-3 * wider);
  EXPECT_EQ(Swept(before, before, before.wet), 0.0);
}

TEST(SweptVolume, DoesNotAskWhichTouchingRowIsTheSeal) {
  // The outer third lies on the plane and slides on it while the dome comes down.
  const auto lying = [](double dome) {
    return
        [dome](double r) { return dome * std::max(1.0 - 2.25 * r * r / (kRadius * kRadius), 0.0); };
  };
  const RingPatch before(lying(0.009));
  RingPatch after(lying(0.007));
  after.nodes.topRows<2>() *= 1.02;
  std::vector<bool> fewer = before.wet;
  for (int i = RingPatch::Node(RingPatch::kRings - 10, 0); i < before.nodes.cols(); ++i) {
    fewer[static_cast<std::size_t>(i)] = false;
  }
  const double swept = Swept(before, after, before.wet);
  EXPECT_LT(swept, -1e-7);
  EXPECT_NEAR(Swept(before, after, fewer), swept, 1e-12 * std::abs(swept));
}

}  // namespace
}  // namespace vacuum_gripper_sim
