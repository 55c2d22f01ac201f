// A sealed cup pulled sideways, on surfaces with friction and without.
#include <gtest/gtest.h>

#include "physics/grip_world.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

constexpr double kPressed = kCupLength - 1e-3;

/// Presses, seals at -6 kPa and pulls sideways.
class Sideways {
 public:
  Sideways(double friction, const SimulatorParameters& parameters)
      : world_({Table(friction)}, {0.0, 0.0, kCupLength + 5e-4}, parameters) {
    world_.MoveTo({0.0, 0.0, kPressed}, 0.02, 0.0);
    world_.Wait(0.2, -6000.0);
  }
  void Pull(double way) { world_.MoveTo({way, 0.0, kPressed}, 0.01, -6000.0); }
  GripWorld& world() { return world_; }

 private:
  GripWorld world_;
};

TEST(Friction, SealedCupSticksUntilTheConeAndThenSlides) {
  for (const double friction : {0.2, 0.5}) {
    SCOPED_TRACE(friction);
    Sideways sideways(friction, A20(0.01));
    const StepResult& result = sideways.world().result();
    ASSERT_EQ(result.status, SealStatus::kSealed);
    const double at_rest = std::abs(sideways.world().force_W().x());
    sideways.Pull(2e-4);
    const double first = std::abs(sideways.world().force_W().x()) - at_rest;
    EXPECT_LT(result.friction_force, 0.5 * friction * result.contact_force);
    sideways.Pull(4e-4);
    // Sticking, the cup is a spring.
    EXPECT_NEAR((std::abs(sideways.world().force_W().x()) - at_rest) / first, 2.0, 0.2);
    sideways.Pull(0.010);
    const double sliding = std::abs(sideways.world().force_W().x());
    EXPECT_NEAR(result.friction_force / result.contact_force, friction, 0.01 * friction);
    EXPECT_NEAR(sliding, result.friction_force, 0.02 * sliding);
    EXPECT_LT(sideways.world().force_W().x(), 0.0);  // the cup holds its mount back
    sideways.Pull(0.015);
    EXPECT_NEAR(std::abs(sideways.world().force_W().x()), sliding, 0.02 * sliding);
    EXPECT_EQ(result.status, SealStatus::kSealed);
    EXPECT_EQ(sideways.world().undone_steps, 0);
  }
}

TEST(Friction, GaussSeidelFindsTheSameForces) {
  SimulatorParameters parameters = A20(0.01);
  Sideways newton(0.5, parameters);
  parameters.contact.method = ContactSolverMethod::kGaussSeidel;
  parameters.contact.max_iterations = 20000;
  Sideways sweeps(0.5, parameters);
  for (const double way : {5e-4, 4e-3}) {
    newton.Pull(way);
    sweeps.Pull(way);
    EXPECT_LT((newton.world().force_W() - sweeps.world().force_W()).norm(),
              1e-3 * newton.world().force_W().norm());
  }
  EXPECT_EQ(sweeps.world().undone_steps, 0);
}

// Slip is what one moves over the other, whoever moves.
TEST(Friction, SurfaceDraggedUnderTheCupPullsAsTheCupDraggedOverIt) {
  Sideways cup_moves(0.4, A20(0.01));
  Sideways plate_moves(0.4, A20(0.01));
  cup_moves.Pull(0.005);
  for (int i = 1; i <= 50; ++i) {
    Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
    X_WO.translation().x() = -1e-4 * i;
    plate_moves.world().simulator().SetObjectPose(0, X_WO);
    plate_moves.world().Step(-6000.0);
  }
  const double force = cup_moves.world().force_W().x();
  // The cup's own inertia makes the first steps differ a little.
  EXPECT_NEAR(plate_moves.world().force_W().x(), force, 1e-3 * std::abs(force));
}

TEST(Friction, ObjectFeelsWhatTheMountFeels) {
  Sideways sideways(0.5, A20(0.01));
  sideways.Pull(2e-3);
  sideways.world().Wait(0.5, -6000.0);
  // At rest and without gravity, what the cup does to the table it does to its mount, reversed.
  const Vector3d on_mount = sideways.world().force_W();
  const ObjectResult& table = sideways.world().object(0);
  EXPECT_LT((table.force_W + on_mount).norm(), 1e-3 * on_mount.norm());
  const Vector3d torque_on_mount =
      sideways.world().result().X_WM.linear() * sideways.world().result().torque_M +
      sideways.world().mount().cross(on_mount);
  EXPECT_LT((table.torque_W + torque_on_mount).norm(), 1e-3 * torque_on_mount.norm() + 1e-6);
}

}  // namespace
}  // namespace vacuum_gripper_sim
