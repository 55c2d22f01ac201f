#include "vacuum_gripper_sim/core/contact_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/block_mesh.h"
#include "support/surface_meshes.h"
#include "vacuum_gripper_sim/core/triangle_mesh.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

constexpr double kTimeStep = 0.01;  // s
constexpr double kFar = 2e-3;       // gaps to look at [m]

enum Kind { kNode, kFace, kFold, kBody };

Kind KindOf(const Contact& contact) {
  if (contact.num_nodes == 0) return kBody;
  if (contact.object == RigidWorld::kNone) return kFold;
  return contact.num_nodes == 1 ? kNode : kFace;
}

/** A block, 40 by 10 by 10 mm, clamped at x = 0, above a plate with friction 0.4 and beside a free
 box whose edge points at it; a second box lies on the first. */
class ContactFinderTest : public testing::Test {
 protected:
  ContactFinderTest() {
    RigidSurface plate{"plate", Box{{0.1, 0.1, 0.01}}};
    plate.friction = 0.4;
    plate.X_FS.translation().z() = -0.0055;
    RigidObject box = Free("box");
    box.surfaces[0].friction = 0.9;
    box.X_WO.linear() = Eigen::AngleAxisd(0.25 * M_PI, Vector3d::UnitX()).toRotationMatrix();
    box.X_WO.translation() = Vector3d(0.0213, 0.0105 + 0.01 * std::sqrt(2.0), 0.0052);
    box.inertia->p_OC = {0.002, 0.0, 0.001};
    RigidObject ball = FixedObject(RigidSurface{"ball", Sphere{0.01}});
    ball.inertia = box.inertia;
    ball.surfaces[0].friction = 0.1;
    ball.X_WO.translation() = box.X_WO.translation() + Vector3d(0.001, 0.0, 0.0) +
                              box.X_WO.linear() * Vector3d(0.0, 0.0, 0.0205);
    world_.SetObjects({FixedObject(plate), box, ball});
    for (int i = 0; i < mesh_.num_nodes(); ++i) {
      nodes_.push_back(i);
      may_touch_.push_back(mesh_.nodes(0, i) > 0.0);
    }
  }
  static RigidObject Free(const std::string& name) {
    RigidObject box = FixedObject(RigidSurface{name, Box{{0.02, 0.02, 0.02}}});
    box.inertia = RigidInertia();
    box.inertia->mass = 0.2;
    return box;
  }
  /// Everybody somewhere else.
  TrialEnd Moved(double way) {
    TrialEnd end;
    end.x_W = mesh_.nodes + way * Eigen::Matrix3Xd::Random(3, mesh_.nodes.cols());
    end.dV = way / kTimeStep * Eigen::VectorXd::Random(12);
    world_.SurfacesAfter(end.dV, kTimeStep, &surfaces_);
    end.surfaces = &surfaces_;
    return end;
  }
  static std::vector<Contact> Near(const ContactFinder& finder, const TrialEnd& end) {
    std::vector<Contact> contacts;
    finder.Select(
        end, [](std::uint64_t, double gap) { return gap < kFar; }, &contacts);
    return contacts;
  }

  TetMesh mesh_ = WithBoundary(MakeBlock(8, 2, 2, {0.04, 0.01, 0.01}, false));
  std::vector<int> nodes_;
  std::vector<bool> may_touch_;
  RigidWorld world_;
  std::vector<RigidSurface> surfaces_;
};

TEST_F(ContactFinderTest, FindsEveryKindOnce) {
  ContactFinder finder(mesh_, nodes_, may_touch_);
  finder.Begin(world_, mesh_.nodes, kTimeStep);
  std::map<std::uint64_t, int> times;
  std::map<Kind, int> kinds;
  const std::vector<double> mu{0.4, 0.9, 0.1};  // by object
  for (const Contact& contact : Near(finder, Moved(0.0))) {
    ++times[contact.key];
    ++kinds[KindOf(contact)];
    EXPECT_TRUE(finder.Sees(contact.key));
    EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
    EXPECT_GT(contact.normal.cross(contact.across).norm(), 0.5);
    for (int k = 0; k < contact.num_nodes; ++k) {
      const int node = contact.nodes[static_cast<std::size_t>(k)];
      if (KindOf(contact) == kNode) {
        EXPECT_GT(mesh_.nodes(0, node), 0.0);
      }  // not the clamped
    }
    const auto mu_of = [&](int object) { return mu[static_cast<std::size_t>(object)]; };
    const double expected = KindOf(contact) == kBody
                                ? std::sqrt(mu_of(contact.object) * mu_of(contact.other))
                                : mu_of(contact.object);
    EXPECT_NEAR(contact.friction, expected, 1e-15);
  }
  for (const auto& [key, count] : times) EXPECT_EQ(count, 1) << key;
  EXPECT_GT(kinds[kNode], 0);
  EXPECT_GT(kinds[kFace], 0);
  EXPECT_GT(kinds[kBody], 0);
}

// The gap's change is that of the contact's own row: n . (sum w dx + dp_other - dp_object).
TEST_F(ContactFinderTest, GapsChangeAsTheirRowsSay) {
  ContactFinder finder(mesh_, nodes_, may_touch_);
  finder.Begin(world_, mesh_.nodes, kTimeStep);
  const TrialEnd rest = Moved(0.0);
  const std::vector<Contact> contacts = Near(finder, rest);
  constexpr double kStep = 1e-7;  // m
  const TrialEnd end = Moved(kStep);
  finder.MoveTo(end);
  for (const Contact& contact : contacts) {
    SCOPED_TRACE(contact.key);
    Vector3d relative = Vector3d::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.num_nodes); ++k) {
      const int node = contact.nodes[k];
      relative += contact.weights[k] * (end.x_W.col(node) - mesh_.nodes.col(node));
    }
    for (const auto& [object, sign] : {std::pair(contact.object, -1.0), {contact.other, 1.0}}) {
      if (object == RigidWorld::kNone || world_.BodyOf(object) == RigidWorld::kNone) continue;
      relative += sign * world_.Displacement(object, contact.p_W, end.dV, kTimeStep);
    }
    const double expected = contact.gap + contact.normal.dot(relative);
    EXPECT_NEAR(finder.Ahead(contact.key, end).gap, expected, 1e-3 * kStep);
    EXPECT_NEAR(finder.At(contact.key, end).gap, expected, 2e-2 * kStep);
    if (contact.friction == 0.0) continue;
    const Vector3d slip = finder.At(contact.key, end).slip_W - relative;
    EXPECT_LT((slip - slip.dot(contact.normal) * contact.normal).norm(), 2e-2 * kStep);
  }
}

// Two legs of a bent strip: one's nodes before the other's faces.
TEST_F(ContactFinderTest, FoldGapsChangeAsTheirRowsSay) {
  const TetMesh strip = WithBoundary(MakeBlock(30, 2, 1, {0.06, 0.004, 0.001}, false));
  constexpr double kLeg = 0.025, kCentre = 1.1e-3;  // m
  Eigen::Matrix3Xd x = strip.nodes;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double s = strip.nodes(0, i) - kLeg, r = kCentre - strip.nodes(2, i);
    const double angle = std::min(s / 6e-4, M_PI);
    if (s <= 0.0) continue;
    x(0, i) = kLeg + r * std::sin(angle) - std::max(0.0, s - 6e-4 * M_PI);
    x(2, i) = kCentre - r * std::cos(angle);
  }
  std::vector<int> nodes;
  std::vector<bool> may_touch;
  for (int i = 0; i < strip.num_nodes(); ++i) {
    nodes.push_back(i);
    may_touch.push_back(strip.nodes(0, i) > 0.0);
  }
  RigidWorld nothing;
  ContactFinder finder(strip, nodes, may_touch);
  finder.Begin(nothing, x, kTimeStep);
  TrialEnd end{x, {}, &nothing.surfaces()};
  const std::vector<Contact> folds = Near(finder, end);
  ASSERT_GT(folds.size(), 10U);
  constexpr double kStep = 1e-7;  // m
  end.x_W += kStep * Eigen::Matrix3Xd::Random(3, x.cols());
  finder.MoveTo(end);
  for (const Contact& fold : folds) {
    ASSERT_EQ(KindOf(fold), kFold);
    double expected = fold.gap;
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      expected +=
          fold.weights[k] * fold.normal.dot(end.x_W.col(fold.nodes[k]) - x.col(fold.nodes[k]));
      sum += fold.weights[k];
    }
    EXPECT_NEAR(sum, 0.0, 1e-12);
    EXPECT_NEAR(finder.Ahead(fold.key, end).gap, expected, 1e-3 * kStep);
    EXPECT_NEAR(finder.At(fold.key, end).gap, expected, 2e-2 * kStep);
  }
}

// A contact that went away is known to have gone; the same one has the same key again.
TEST_F(ContactFinderTest, KeysStayAndTellWhatIsGone) {
  ContactFinder finder(mesh_, nodes_, may_touch_);
  finder.Begin(world_, mesh_.nodes, kTimeStep);
  const std::vector<Contact> before = Near(finder, Moved(0.0));
  const Eigen::Isometry3d X_WO = world_.objects()[1].X_WO;
  world_.SetPose(1, Eigen::Translation3d(0.0, 0.5, 0.0) * X_WO);
  finder.Begin(world_, mesh_.nodes, kTimeStep);
  for (const Contact& contact : before) {
    const bool with_the_box = contact.object == 1 || contact.other == 1;
    EXPECT_EQ(finder.Sees(contact.key), KindOf(contact) == kNode || !with_the_box);
  }
  world_.SetPose(1, X_WO);
  finder.Begin(world_, mesh_.nodes, kTimeStep);
  const std::vector<Contact> after = Near(finder, Moved(0.0));
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].key, before[i].key);
    EXPECT_EQ(after[i].nodes, before[i].nodes);
    EXPECT_EQ(after[i].gap, before[i].gap);
  }
}

// The clamped end does not move for an edge that does not move: no row that is zero.
TEST_F(ContactFinderTest, ClampedFacesTouchNoFixedEdge) {
  RigidObject blade = FixedObject(RigidSurface{"blade", Box{{0.02, 0.02, 0.02}}});
  blade.X_WO.translation() = Vector3d(-0.0105, 0.005, 0.0);  // its edge before the clamped end
  RigidWorld world;
  for (const bool free : {false, true}) {
    if (free) blade.inertia = RigidInertia{0.1, Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    world.SetObjects({blade});
    ContactFinder finder(mesh_, nodes_, may_touch_);
    finder.Begin(world, mesh_.nodes, kTimeStep);
    int edges = 0;
    TrialEnd end{mesh_.nodes, Eigen::VectorXd::Zero(6 * world.num_bodies()), &world.surfaces()};
    for (const Contact& contact : Near(finder, end)) {
      if (KindOf(contact) != kFace) continue;
      ++edges;
      double free_weight = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        if (mesh_.nodes(0, contact.nodes[k]) > 0.0) free_weight += contact.weights[k];
      }
      if (!free) {
        EXPECT_GT(free_weight, 0.0);
      }
    }
    EXPECT_EQ(edges > 0, free);
  }
}

// Pressure on a point pushes what is nearest to it, also where a mesh was only known to be far.
TEST_F(ContactFinderTest, NearestSurfaceIsExactFarFromMeshes) {
  const Triangles raw = MakeSheet(2, 1.0);
  const auto sheet = std::make_shared<const TriangleMesh>("sheet", raw.vertices, raw.triangles);
  RigidObject far = FixedObject(RigidSurface{"far", sheet});
  far.X_WO.translation().z() = -0.03;
  RigidObject near = FixedObject(RigidSurface{"near", Box{{1.0, 1.0, 0.01}}});
  near.X_WO.translation().z() = -0.02;  // 15 mm below
  RigidWorld world;
  world.SetObjects({far, near});
  ContactFinder finder(mesh_, nodes_, may_touch_);
  Eigen::Matrix3Xd x_W = mesh_.nodes;
  // On its way sideways a node knows less and less how far the sheet is.
  for (int step = 0; step < 30; ++step) {
    x_W.row(0).array() += 1e-3;
    finder.Begin(world, x_W, kTimeStep);
    for (const int node : nodes_) EXPECT_EQ(finder.NearestSurface(node), 1);
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
