#include "vacuum_gripper_sim/core/self_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "support/block_mesh.h"
#include "vacuum_gripper_sim/core/gmsh_reader.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 5e-4;  // m

/// A strip along x, 60 by 4 by 1 mm.
TetMesh Strip(bool quadratic) {
  return WithBoundary(MakeBlock(30, 2, 1, Vector3d(0.060, 0.004, 0.001), quadratic));
}

constexpr double kThickness = 1e-3;  // m
constexpr double kLeg = 0.025;       // m, from the clamped end to the bend
constexpr double kBend = 1e-4;       // m, inner radius of the bend

/// The strip bent into a hairpin; the upper faces of its legs face each other at a distance of 2
/// kBend, less `sunk`.
Eigen::Matrix3Xd Hairpin(const Eigen::Matrix3Xd& rest, double sunk) {
  const double length = M_PI * (kBend + 0.5 * kThickness);
  Eigen::Matrix3Xd x = rest;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const double s = rest(0, i) - kLeg, z = rest(2, i);
    if (s <= 0.0) continue;
    const double centre = kThickness + kBend;
    if (s < length) {
      const double angle = M_PI * s / length, radius = centre - z;
      x(0, i) = kLeg + radius * std::sin(angle);
      x(2, i) = centre - radius * std::cos(angle) - sunk * s / length;
    } else {
      x(0, i) = kLeg - (s - length);
      x(2, i) = 2.0 * centre - z - sunk;
    }
  }
  return x;
}

class HairpinTest : public testing::TestWithParam<bool> {};

// Every node of the upper faces that has the other leg before it, at its distance and from above or
// below; nothing else.
TEST_P(HairpinTest, LegsMeetAtTheirDistance) {
  const TetMesh mesh = Strip(GetParam());
  CupFaces faces(mesh);
  const SelfContact self_contact(mesh, faces);
  for (const double sunk : {-1e-4, 0.0, 1.5e-4, 2e-4, 3e-4, 5e-4}) {
    SCOPED_TRACE(sunk);
    const Eigen::Matrix3Xd x = Hairpin(mesh.nodes, sunk);
    faces.Update(x);
    const double gap = 2.0 * kBend - sunk;
    std::set<int> met;
    for (const FoldContact& contact : self_contact.Find(faces, x, kReach)) {
      const Vector3d p = x.col(contact.node);
      Vector3d foot = Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        foot += contact.weights(k) * x.col(contact.face[static_cast<std::size_t>(k)]);
      }
      EXPECT_NEAR(contact.weights.sum(), 1.0, 1e-12);
      EXPECT_GE(contact.weights.minCoeff(), 0.0);
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
      EXPECT_NEAR(contact.normal.dot(p - foot), contact.gap, 1e-12);
      EXPECT_NEAR(mesh.nodes(2, contact.node), kThickness, 1e-12);
      for (const int node : contact.face) EXPECT_NEAR(mesh.nodes(2, node), kThickness, 1e-12);
      // The bend, and what hangs over the clamped end.
      if (x(0, contact.node) > 0.9 * kLeg || x(0, contact.node) < 0.0) continue;
      EXPECT_NEAR(contact.gap, gap, 1e-9);
      const bool lower_leg = mesh.nodes(0, contact.node) < kLeg;
      EXPECT_NEAR(contact.normal.z(), lower_leg ? -1.0 : 1.0, 1e-6);
      met.insert(contact.node);
    }
    // The upper leg is shorter: its end is at x_end; half walls are half the strip's thickness.
    const double x_end = kLeg - (0.060 - kLeg - M_PI * (kBend + 0.5 * kThickness));
    for (int node = 0; node < mesh.num_nodes(); ++node) {
      const bool upper_face = mesh.nodes(2, node) == kThickness;
      const bool clamped =
          std::binary_search(mesh.mount_nodes.begin(), mesh.mount_nodes.end(), node);
      const bool below = x(0, node) > std::max(0.0, x_end) && x(0, node) < 0.9 * kLeg;
      if (upper_face && below && !clamped) {
        EXPECT_EQ(met.count(node), 1U) << x.col(node).transpose();
      }
    }
    EXPECT_GT(met.size(), 50U);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, HairpinTest, testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "quadratic" : "linear");
});

TEST(SelfContact, HalfWallIsHalfTheThickness) {
  const TetMesh mesh = Strip(false);
  const SelfContact self_contact(mesh, CupFaces(mesh));
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const Vector3d p = mesh.nodes.col(node);
    const bool on_rim = p.y() < 1e-6 || p.y() > 0.0039 || p.x() > 0.0599 || p.x() < 1e-6;
    if (on_rim) continue;
    EXPECT_NEAR(self_contact.half_wall(node), 0.5 * kThickness, 1e-9);
  }
}

// A flat strip, and one bent gently the other way round, touch nothing.
TEST(SelfContact, NothingTouchesAlongASmoothSurface) {
  const TetMesh mesh = Strip(true);
  CupFaces faces(mesh);
  const SelfContact self_contact(mesh, faces);
  EXPECT_TRUE(self_contact.Find(faces, mesh.nodes, kReach).empty());
  Eigen::Matrix3Xd bent = mesh.nodes;
  for (Eigen::Index i = 0; i < bent.cols(); ++i) {
    const double angle = mesh.nodes(0, i) / 0.015, radius = 0.015 - mesh.nodes(2, i);
    bent(0, i) = radius * std::sin(angle);
    bent(2, i) = -radius * std::cos(angle);
  }
  faces.Update(bent);
  EXPECT_TRUE(self_contact.Find(faces, bent, kReach).empty());
}

TEST(SelfContact, CupsAtRestTouchNothing) {
  int num_cups = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(VACUUM_GRIPPER_SOURCE_DIR "/meshes")) {
    if (entry.path().extension() != ".msh") continue;
    const TetMesh mesh = ReadGmsh(entry.path().string());
    const CupFaces faces(mesh);
    EXPECT_TRUE(SelfContact(mesh, faces).Find(faces, mesh.nodes, kReach).empty()) << entry.path();
    ++num_cups;
  }
  EXPECT_GE(num_cups, 9);
}

// The middle of the bellows' wall has its waist here, see config/cups/profiles/bellows_1600.yaml.
constexpr double kWaistRadius = 0.0075, kWaistHeight = 0.0052;  // m
// Where the outer faces of skirt and cone would meet without a fillet: half a wall off the middle
// lines, which rise by 45 degrees.
constexpr double kRootRadius = kWaistRadius + 0.00106;  // m

/// Turns the skirt up by an angle about the root of the outer fold.
Eigen::Matrix3Xd FoldBellows(const Eigen::Matrix3Xd& rest, double angle) {
  Eigen::Matrix3Xd x = rest;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const double radius = rest.col(i).head<2>().norm();
    const double u = radius - kRootRadius, v = rest(2, i) - kWaistHeight;
    if (v > 0.001) continue;
    const double turn = angle * std::clamp(0.5 - v / 0.002, 0.0, 1.0);
    const double new_radius = radius + u * (std::cos(turn) - 1.0) - v * std::sin(turn);
    x.col(i).head<2>() *= new_radius / radius;
    x(2, i) = kWaistHeight + u * std::sin(turn) + v * std::cos(turn);
  }
  return x;
}

// Skirt against cone, outside, as near as a search through all faces finds them.
TEST(SelfContact, FoldedBellowsMeetsOnTheOutsideOfItsWaist) {
  for (const char* const name : {"linear", "quadratic"}) {
    SCOPED_TRACE(name);
    const TetMesh mesh =
        ReadGmsh(VACUUM_GRIPPER_SOURCE_DIR "/meshes/bellows_" + std::string(name) + "_1600.msh");
    CupFaces faces(mesh);
    const SelfContact self_contact(mesh, faces);
    const Eigen::Matrix3Xd x = FoldBellows(mesh.nodes, 1.5);
    faces.Update(x);
    const std::set<int> cavity(mesh.cavity_faces.data(),
                               mesh.cavity_faces.data() + mesh.cavity_faces.size());
    const auto contacts = self_contact.Find(faces, x, kReach);
    int on_skirt = 0, on_cone = 0;
    for (const FoldContact& contact : contacts) {
      const bool skirt = mesh.nodes(2, contact.node) < kWaistHeight;
      ++(skirt ? on_skirt : on_cone);
      for (const int node : contact.face) {
        EXPECT_EQ(mesh.nodes(2, node) > kWaistHeight, skirt);
        EXPECT_GT(mesh.nodes.col(node).head<2>().norm(), kWaistRadius);
      }
      double nearest = 1.0;
      for (Eigen::Index t = 0; t < faces.triangles().cols(); ++t) {
        bool other_side = true;
        for (int k = 0; k < 3; ++k) {
          const double v = mesh.nodes(2, faces.triangles()(k, t)) - kWaistHeight;
          other_side &= skirt ? v > 0.002 : v < -0.002;
        }
        if (!other_side) continue;
        const auto corner = [&](int k) -> Vector3d { return x.col(faces.triangles()(k, t)); };
        nearest = std::min(nearest, std::sqrt(NearestOnTriangle(corner(0), corner(1), corner(2),
                                                                x.col(contact.node))
                                                  .squared_distance));
      }
      EXPECT_LE(std::abs(contact.gap), nearest + 1e-12);
    }
    EXPECT_GE(on_cone, 24);
    // The linear skirt has no nodes between its ends.
    EXPECT_GE(on_skirt, mesh.quadratic() ? 24 : 0);
  }
}

// A contact that is measured again elsewhere keeps its face.
TEST(SelfContact, AtMeasuresTheSamePairElsewhere) {
  const TetMesh mesh = Strip(false);
  CupFaces faces(mesh);
  const SelfContact self_contact(mesh, faces);
  Eigen::Matrix3Xd x = Hairpin(mesh.nodes, 0.0);
  faces.Update(x);
  const auto contacts = self_contact.Find(faces, x, kReach);
  ASSERT_FALSE(contacts.empty());
  x = Hairpin(mesh.nodes, 2.5e-4);
  faces.Update(x);
  int num_checked = 0;
  for (const FoldContact& contact : contacts) {
    if (x(0, contact.node) > 0.8 * kLeg || x(0, contact.node) < 0.001) continue;
    const FoldContact sunk = SelfContact::At(contact, faces, x);
    EXPECT_EQ(sunk.face, contact.face);
    EXPECT_NEAR(sunk.gap, -5e-5, 1e-9);
    EXPECT_LT((sunk.normal - contact.normal).norm(), 1e-6);
    ++num_checked;
  }
  EXPECT_GT(num_checked, 20);
}

}  // namespace
}  // namespace vacuum_gripper_sim
