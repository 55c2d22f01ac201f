#include "vacuum_gripper_sim/core/rigid_world.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

RigidObject Top() {
  RigidObject top = FixedObject(RigidSurface{"top", Box{{0.02, 0.04, 0.06}}});
  RigidInertia inertia;
  inertia.mass = 0.2;
  inertia.p_OC = {0.001, 0.0, 0.002};
  inertia.about_C_O = Vector3d(3e-5, 2e-5, 1.5e-5).asDiagonal();
  top.inertia = inertia;
  top.X_WO.translation() = Vector3d(0.1, 0.2, 0.3);
  return top;
}

TEST(RigidWorld, FallsAsGravityHasIt) {
  RigidWorld world;
  world.SetObjects({Top()});
  const Vector3d gravity(0.0, 0.0, -9.81);
  const double h = 0.001;
  for (int i = 0; i < 100; ++i) {
    Eigen::VectorXd b;
    world.FreeImpulse(gravity, h, &b);
    world.Advance(world.Mass(0).inverse() * b, h);
  }
  EXPECT_NEAR(world.velocity(0).z(), -0.981, 1e-12);
  EXPECT_NEAR(world.objects()[0].X_WO.translation().z(), 0.3 - 0.5 * 9.81 * 0.1 * 0.101, 1e-12);
  EXPECT_NEAR(world.surfaces()[0].X_FS.translation().z(), world.objects()[0].X_WO.translation().z(),
              1e-15);
}

// Without forces the angular momentum stays: to the order of the time step, as velocities at the
// start of each step turn the body.
TEST(RigidWorld, KeepsItsAngularMomentum) {
  double error[2];
  const double steps[2] = {2e-4, 1e-4};
  for (int k = 0; k < 2; ++k) {
    RigidWorld world;
    world.SetObjects({Top()});
    Eigen::VectorXd spin(6);
    spin << 0.0, 0.0, 0.0, 3.0, 8.0, 1.0;
    world.Advance(spin, 0.0);
    const Vector3d before = world.Mass(0).bottomRightCorner<3, 3>() * world.velocity(0).tail<3>();
    const Vector3d c_before = world.CentreOfMass(0);
    for (int i = 0; i < std::lround(0.2 / steps[k]); ++i) {
      Eigen::VectorXd b;
      world.FreeImpulse(Vector3d::Zero(), steps[k], &b);
      world.Advance(world.Mass(0).inverse() * b, steps[k]);
    }
    const Vector3d after = world.Mass(0).bottomRightCorner<3, 3>() * world.velocity(0).tail<3>();
    error[k] = (after - before).norm() / before.norm();
    EXPECT_LT((world.CentreOfMass(0) - c_before).norm(), 1e-12);
    EXPECT_TRUE(IsRigidMotion(world.objects()[0].X_WO));
  }
  EXPECT_LT(error[1], 5e-3);
  EXPECT_LT(error[1], 0.6 * error[0]);
}

TEST(RigidWorld, DisplacementsAreThoseOfPoints) {
  RigidObject belt = FixedObject(RigidSurface{"belt", Plane{}});
  RigidWorld world;
  world.SetObjects({belt, Top()});
  EXPECT_EQ(world.BodyOf(0), RigidWorld::kNone);
  EXPECT_EQ(world.BodyOf(1), 0);
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.translation().x() = 0.01;
  world.SetPose(0, moved);
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(6);
  EXPECT_LT(
      (world.Displacement(0, {0.5, 0.0, 0.0}, at_rest, 0.01) - Vector3d(0.01, 0.0, 0.0)).norm(),
      1e-15);
  world.Advance(at_rest, 0.01);
  EXPECT_EQ(world.Displacement(0, {0.5, 0.0, 0.0}, at_rest, 0.01).norm(), 0.0);

  Eigen::VectorXd dV(6);
  dV << 0.0, 0.0, 0.0, 0.0, 0.0, 0.1;
  const Vector3d p_W = world.CentreOfMass(0) + Vector3d(0.02, 0.0, 0.0);
  EXPECT_LT((world.Displacement(1, p_W, dV, 0.01) - Vector3d(0.0, 0.02 * 0.001, 0.0)).norm(), 1e-7);
}

TEST(RigidObject, BadOnesAreRefusedByNameAndField) {
  const auto expect_refused = [](const RigidObject& object, const std::string& word) {
    try {
      Validate(object);
      FAIL() << word;
    } catch (const std::invalid_argument& e) {
      const std::string text = e.what();
      EXPECT_NE(text.find("'top'"), std::string::npos) << text;
      EXPECT_NE(text.find(word), std::string::npos) << text;
    }
  };
  Validate(Top());
  for (const double mass : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    RigidObject bad = Top();
    bad.inertia->mass = mass;
    expect_refused(bad, "mass");
  }
  RigidObject bad = Top();
  bad.inertia->about_C_O = Vector3d(1e-5, 1e-5, 3e-5).asDiagonal();
  expect_refused(bad, "principal moments");
  bad.inertia->about_C_O = Vector3d(1e-5, 1e-5, -1e-5).asDiagonal();
  expect_refused(bad, "principal moments");
  bad = Top();
  bad.inertia->about_C_O(0, 1) = 1e-5;
  expect_refused(bad, "symmetric");
  bad = Top();
  bad.surfaces[0].friction = -0.1;
  expect_refused(bad, "friction");
  bad = Top();
  bad.surfaces.clear();
  expect_refused(bad, "surface");
  bad = Top();
  bad.X_WO.linear() *= 2.0;
  expect_refused(bad, "pose");
  bad = Top();
  bad.surfaces[0].shape = Plane{};  // a half space has no inertia
  expect_refused(bad, "plane");
  bad.inertia.reset();
  Validate(bad);
}

}  // namespace
}  // namespace vacuum_gripper_sim
