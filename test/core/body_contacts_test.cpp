#include "vacuum_gripper_sim/core/body_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "support/surface_meshes.h"
#include "vacuum_gripper_sim/core/triangle_mesh.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 1e-3;  // m

RigidObject Free(Shape shape, const Eigen::Isometry3d& X_WO) {
  RigidObject object = FixedObject(RigidSurface{"free", std::move(shape)});
  object.X_WO = X_WO;
  object.inertia = RigidInertia();
  object.inertia->mass = 1.0;
  return object;
}

RigidObject Ground() { return FixedObject(RigidSurface{"ground", Plane{}}); }

Eigen::Isometry3d Pose(const Vector3d& position, double angle = 0.0,
                       const Vector3d& axis = Vector3d::UnitX()) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = position;
  X.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  return X;
}

std::vector<BodyContacts::Pair> PairsOf(std::vector<RigidObject> objects, double reach = kReach) {
  RigidWorld world;
  world.SetObjects(std::move(objects));
  BodyContacts contacts;
  contacts.Begin(world, reach);
  return contacts.pairs();
}

TEST(BodyContacts, BoxStandsOnItsCorners) {
  const auto pairs = PairsOf({Ground(), Free(Box{{0.02, 0.04, 0.06}}, Pose({0.0, 0.0, 0.0305}))});
  ASSERT_EQ(pairs.size(), 4U);  // not on the points along its edges: they share the same load
  for (const BodyContacts::Pair& pair : pairs) {
    EXPECT_NEAR(std::abs(pair.p_W.x()), 0.01, 1e-15);
    EXPECT_NEAR(std::abs(pair.p_W.y()), 0.02, 1e-15);
    EXPECT_NEAR(pair.seen.distance, 5e-4, 1e-15);
    EXPECT_EQ(pair.seen.normal, Vector3d::UnitZ());
    EXPECT_EQ(pair.feeling, 1);
    EXPECT_EQ(pair.surface, 0);
  }
}

// A box across a beam: no corner of either is near the other, but points of its edges are.
TEST(BodyContacts, BoxOverABeamIsFeltAlongItsEdges) {
  const auto pairs = PairsOf({FixedObject(RigidSurface{"beam", Box{{0.02, 1.0, 0.02}}}),
                              Free(Box{{0.4, 0.1, 0.02}}, Pose({0.0, 0.0, 0.02}, 0.0))});
  EXPECT_TRUE(std::all_of(pairs.begin(), pairs.end(), [](const BodyContacts::Pair& pair) {
    return std::abs(pair.seen.distance) < kReach;
  }));
  // Tilted about the beam's axis, the middles of its long edges carry it.
  const auto tilted =
      PairsOf({FixedObject(RigidSurface{"beam", Box{{0.02, 1.0, 0.02}}}),
               Free(Box{{0.4, 0.1, 0.02}}, Pose({0.0, 0.0, 0.02}, 0.1, Vector3d::UnitY()))},
              2e-3);
  EXPECT_FALSE(tilted.empty());
}

TEST(BodyContacts, SphereIsFeltByItsMiddleAndRadius) {
  const auto pairs = PairsOf({Ground(), Free(Sphere{0.03}, Pose({0.1, 0.2, 0.0301}))});
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].radius, 0.03);
  EXPECT_NEAR(pairs[0].seen.distance, 1e-4, 1e-15);
  EXPECT_TRUE(PairsOf({Ground(), Free(Sphere{0.03}, Pose({0.1, 0.2, 0.04}))}).empty());
}

TEST(BodyContacts, CylinderStandsOnItsRimAndLiesOnItsDeepestPoints) {
  const Cylinder cylinder{0.03, 0.1};
  const auto standing = PairsOf({Ground(), Free(cylinder, Pose({0.0, 0.0, 0.05}))});
  EXPECT_EQ(standing.size(), 8U);
  // Turned about its axis by any angle, it lies on two points.
  for (const double angle : {0.1, 0.5, 2.0}) {
    Eigen::Isometry3d lying = Pose({0.0, 0.0, 0.03}, 0.5 * M_PI);
    lying.rotate(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
    int touching = 0;
    for (const BodyContacts::Pair& pair : PairsOf({Ground(), Free(cylinder, lying)})) {
      touching += std::abs(pair.seen.distance) < 1e-12 ? 1 : 0;
    }
    EXPECT_EQ(touching, 2) << angle;
  }
}

TEST(BodyContacts, MeshIsFeltByItsVertices) {
  const Triangles raw = MakeBoxMesh(2, {0.02, 0.02, 0.02});
  const auto mesh = std::make_shared<const TriangleMesh>("mesh", raw.vertices, raw.triangles);
  const auto pairs = PairsOf({Ground(), Free(mesh, Pose({0.0, 0.0, 0.01}))});
  EXPECT_EQ(pairs.size(), 9U);
  for (const BodyContacts::Pair& pair : pairs) EXPECT_NEAR(pair.seen.distance, 0.0, 1e-15);
}

// A sheet has two sides: what is behind it is not inside anything.
TEST(BodyContacts, SheetIsFeltFromBothSides) {
  Triangles raw = MakeSheet(2, 0.2);
  const auto sheet = std::make_shared<const TriangleMesh>("mesh", raw.vertices, raw.triangles);
  for (const double side : {-1.0, 1.0}) {
    RigidWorld world;
    world.SetObjects({FixedObject(RigidSurface{"sheet", sheet}),
                      Free(Sphere{0.03}, Pose({0.01, 0.02, side * 0.0301}))});
    BodyContacts contacts;
    contacts.Begin(world, kReach);
    bool is_felt = false;
    for (const BodyContacts::Pair& pair : contacts.pairs()) {
      if (pair.feeling != 1) continue;
      is_felt = true;
      EXPECT_NEAR(pair.seen.distance, 1e-4, 1e-12);
      EXPECT_NEAR(pair.seen.normal.z(), side, 1e-12);
      // A trial past the sheet is still seen from where it began.
      const Vector3d p_W(0.01, 0.02, -side * 0.001);
      EXPECT_NEAR(contacts.Look(pair, world.surfaces()[0], p_W).distance, -0.001, 1e-12);
    }
    EXPECT_TRUE(is_felt);
  }
}

TEST(BodyContacts, FixedObjectsDoNotFeelEachOther) {
  EXPECT_TRUE(PairsOf({Ground(), FixedObject(RigidSurface{"box", Box{{0.1, 0.1, 0.1}}})}).empty());
}

// An id names the same point of the same two surfaces, whichever others come near.
TEST(BodyContacts, IdsStayFromStepToStep) {
  RigidWorld world;
  world.SetObjects({Ground(), Free(Box{{0.02, 0.04, 0.06}}, Pose({0.0, 0.0, 0.031})),
                    Free(Cylinder{0.01, 0.05}, Pose({0.1, 0.0, 0.026}))});
  struct Name {
    int feeling, surface;
    Vector3d p_S;
  };
  std::map<std::uint32_t, Name> names;
  BodyContacts contacts;
  for (int step = 0; step < 20; ++step) {
    world.SetPose(
        1, Pose({0.004 * step, 0.0, 0.031}, 0.05 * step, Vector3d(1.0, 0.5, 0.2).normalized()));
    world.SetPose(2, Pose({0.1, 0.0, 0.026}, 0.2 * step, Vector3d(0.3, 0.1, 1.0).normalized()));
    contacts.Begin(world, 0.02);
    for (std::size_t i = 0; i < contacts.pairs().size(); ++i) {
      const BodyContacts::Pair& pair = contacts.pairs()[i];
      if (i > 0) {
        EXPECT_LT(contacts.pairs()[i - 1].id, pair.id);
      }
      EXPECT_TRUE(contacts.Sees(pair.id));
      EXPECT_EQ(&contacts.Find(pair.id), &pair);
      const RigidSurface& feeling = world.surfaces()[static_cast<std::size_t>(pair.feeling)];
      const Name now{pair.feeling, pair.surface, feeling.X_FS.inverse() * pair.p_W};
      const auto [before, is_new] = names.emplace(pair.id, now);
      if (is_new) continue;
      EXPECT_EQ(now.feeling, before->second.feeling);
      EXPECT_EQ(now.surface, before->second.surface);
      // The deepest point of a cylinder's rim moves along it, never to the other one.
      if (feeling.shape.index() == 1) {
        EXPECT_LT((now.p_S - before->second.p_S).norm(), 1e-12);
      }
      EXPECT_GT(now.p_S.z() * before->second.p_S.z(), -1e-12);
    }
  }
  EXPECT_GT(names.size(), 20U);
  EXPECT_FALSE(contacts.Sees(names.rbegin()->first + 1000));
}

}  // namespace
}  // namespace vacuum_gripper_sim
