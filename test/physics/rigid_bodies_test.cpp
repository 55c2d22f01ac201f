// Free bodies against closed-form answers: on an incline, hanging from the cup, pulled.
#include <gtest/gtest.h>

#include "physics/grip_world.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

const Vector3d kAway(0.5, 0.5, 0.5);  // a mount out of everything's way

Eigen::Isometry3d Tilted(double angle) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix();
  return X;
}

/// A block that starts at rest, touching an incline of 20 degrees.
class Incline {
 public:
  explicit Incline(double friction)
      : world_({Table(friction, Tilted(kAngle)), Block(friction)}, kAway, WithGravity(A20(0.01))) {}
  /// Way down the slope after a time. [m]
  double Slide(double time) {
    const Vector3d before = world_.object(1).X_WO.translation();
    world_.Wait(time, 0.0);
    EXPECT_EQ(world_.undone_steps, 0);
    return (world_.object(1).X_WO.translation() - before)
        .dot(Tilted(kAngle).linear() * Vector3d::UnitX());
  }
  const Eigen::Isometry3d& pose() const { return world_.object(1).X_WO; }
  static constexpr double kAngle = 20.0 / 180.0 * M_PI;

 private:
  static RigidObject Block(double friction) {
    RigidObject block = FreeBox({0.06, 0.05, 0.02}, 0.1, friction, Vector3d::Zero());
    block.X_WO = Tilted(kAngle);
    block.X_WO.translation() = block.X_WO.linear() * Vector3d(0.0, 0.0, 0.01);
    return block;
  }
  GripWorld world_;
};

TEST(RigidBodies, BlockSticksBelowTheAngleOfFriction) {
  Incline incline(1.05 * std::tan(Incline::kAngle));
  EXPECT_NEAR(incline.Slide(1.0), 0.0, 1e-6);
}

TEST(RigidBodies, BlockSlidesAboveTheAngleOfFriction) {
  const double friction = 0.5 * std::tan(Incline::kAngle);
  Incline incline(friction);
  const double time = 0.5;
  const double acceleration =
      kGravity * (std::sin(Incline::kAngle) - friction * std::cos(Incline::kAngle));
  // Implicit Euler moves with the velocity at a step's end: t (t + h) / 2.
  EXPECT_NEAR(incline.Slide(time) / (0.5 * acceleration * time * (time + 0.01)), 1.0, 1e-3);
  EXPECT_LT((incline.pose().linear() - Tilted(Incline::kAngle).linear()).norm(), 1e-6);
}

TEST(RigidBodies, DroppedBoxComesToRestOnItsFace) {
  RigidObject box = FreeBox({0.06, 0.05, 0.04}, 0.1, 0.5, {0.0, 0.0, 0.05});
  box.X_WO.linear() =
      Eigen::AngleAxisd(0.3, Vector3d(1.0, 0.5, 0.0).normalized()).toRotationMatrix();
  GripWorld world({Table(0.5), box}, kAway, WithGravity(A20(0.005)));
  world.Wait(1.5, 0.0);
  EXPECT_EQ(world.undone_steps, 0);
  const ObjectResult& end = world.object(1);
  EXPECT_NEAR(end.X_WO.translation().z(), 0.02, 1e-6);
  EXPECT_NEAR(end.X_WO.linear()(2, 2), 1.0, 1e-6);
  EXPECT_LT(end.velocity_W.norm(), 1e-6);
}

/// A box on a table, held by the cup at -6 kPa and lifted.
class Hanging : public GripWorld {
 public:
  Hanging(double mass, double friction, SimulatorParameters parameters,
          const Vector3d& size = {0.06, 0.06, 0.03})
      : GripWorld({Table(friction), FreeBox(size, mass, friction, {0.0, 0.0, 0.5 * size.z()})},
                  {0.0, 0.0, size.z() + kCupLength + 1e-3}, parameters) {
    const double top = size.z() + kCupLength;
    MoveTo({0.0, 0.0, top - 1e-3}, 0.02, 0.0);
    Wait(0.1, -6000.0);
    MoveTo({0.0, 0.0, top + 0.02}, 0.05, -6000.0);
  }
};

TEST(RigidBodies, HangingBoxWeighsWhatItWeighs) {
  for (const double friction : {0.3, 0.5}) {
    SCOPED_TRACE(friction);
    Hanging world(0.1, friction, WithGravity(A20(0.01)));
    const double empty = 0.1 * kGravity;
    world.Wait(3.0, -6000.0);
    EXPECT_EQ(world.undone_steps, 0);
    ASSERT_EQ(world.result().status, SealStatus::kSealed);
    EXPECT_NEAR(world.object(1).force_W.z(), empty, 1e-3 * empty);
    EXPECT_LT(world.object(1).velocity_W.norm(), 1e-4);
    std::printf("friction %.1f: force %.5f of %.5f N, mount %.5f, iterations %d, %.2f ms, v %.2e\n",
                friction, world.object(1).force_W.z(), empty, world.result().force_M.z(),
                world.iterations, 1e3 * world.time_spent / world.steps,
                world.object(1).velocity_W.norm());
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
