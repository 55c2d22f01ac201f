// The Simulator's promises to its caller: commands, refusals, undone steps, reset.
#include "vacuum_gripper_sim/core/simulator.h"

#include <gtest/gtest.h>

#include <limits>

#include "physics/grip_cycle.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Simulator, MountFrameHasItsOriginOnTopAndZOutOfTheCup) {
  const TetMesh mesh = LoadBell("linear_700");
  const Eigen::Isometry3d X_MR = MountFromRest(mesh);
  EXPECT_LT((X_MR * Eigen::Vector3d(0.0, 0.0, 0.020)).norm(), 1e-12);
  EXPECT_LT((X_MR * Eigen::Vector3d(0.01, 0.02, 0.0) - Eigen::Vector3d(0.01, -0.02, 0.02)).norm(),
            1e-12);
}

TEST(Simulator, RefusedCommandMovesNothing) {
  GripCycle cycle(LoadBell("linear_700"), A20(0.01));
  cycle.Drive(kCupLength - 0.001, 0.01, 0.0, 0.05);
  const Eigen::Matrix3Xd before = cycle.result().x_W;
  const double time = cycle.result().time;
  const Command good{cycle.result().X_WM, 0.0};

  Command not_finite = good;
  not_finite.X_WM.translation().x() = kNan;
  Command not_a_rotation = good;
  not_a_rotation.X_WM.linear() *= 1.1;
  for (const Command& bad : {not_finite, not_a_rotation, Command{good.X_WM, 5000.0},
                             Command{good.X_WM, kNan}, Command{good.X_WM, -1e6}}) {
    const StepResult& result = cycle.simulator().Step(bad);
    EXPECT_EQ(result.outcome, StepOutcome::kNonFinite);
    EXPECT_FALSE(result.message.empty());
    EXPECT_EQ(result.x_W, before);
  }
  EXPECT_NEAR(cycle.result().time, time + 0.05, 1e-12);  // time goes on
  EXPECT_EQ(cycle.simulator().Step(good).outcome, StepOutcome::kOk);
  EXPECT_TRUE(cycle.result().x_W.allFinite());
}

// Gauss-Seidel with a single cold sweep misses every bound: such steps are undone and say so.
TEST(Simulator, UnconvergedStepIsUndone) {
  SimulatorParameters parameters = A20(0.01);
  parameters.contact.method = ContactSolverMethod::kGaussSeidel;
  parameters.contact.max_iterations = 1;
  parameters.contact.acceptable_residual = 1e-9;
  GripCycle cycle(LoadBell("linear_700"), parameters);
  cycle.Drive(kCupLength + 5e-5, 0.01, 0.0);
  EXPECT_EQ(cycle.undone_steps, 0);
  cycle.Drive(kCupLength - 0.001, 0.01, 0.0);
  EXPECT_GT(cycle.undone_steps, 0);
  EXPECT_EQ(cycle.result().outcome, StepOutcome::kUnconverged);
  EXPECT_NE(cycle.result().message.find("acceptable_residual"), std::string::npos);
  EXPECT_TRUE(cycle.result().x_W.allFinite());
  EXPECT_LE(cycle.max_penetration, 1e-6);  // the last good state stays
}

TEST(Simulator, ResetGivesTheRestShapeAndKeepsTime) {
  GripCycle cycle(LoadBell("linear_700"), A20(0.01));
  const Eigen::Matrix3Xd rest = cycle.result().x_W;
  const Eigen::Isometry3d start = cycle.result().X_WM;
  cycle.Drive(kCupLength - 0.001, 0.01, -6000.0, 0.2);
  EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
  const double time = cycle.result().time;
  cycle.simulator().Reset(start);
  EXPECT_EQ(cycle.result().x_W, rest);
  EXPECT_EQ(cycle.result().status, SealStatus::kOpen);
  EXPECT_EQ(cycle.result().gauge_pressure, 0.0);
  EXPECT_EQ(cycle.result().time, time);
  cycle.simulator().Step({start, 0.0});
  EXPECT_LT(cycle.result().force_M.norm(), 1e-9);
}

// The regulator takes |p| / ramp_rate to its set-point, meets it exactly, and vents as fast.
TEST(Simulator, PressureFollowsTheRamp) {
  GripCycle cycle(LoadBell("linear_700"), A20(0.01));
  cycle.Drive(kCupLength - 0.001, 0.01, 0.0, 0.1);
  cycle.Step(-2500.0);  // 100 kPa/s: 1 kPa a step
  EXPECT_EQ(cycle.result().status, SealStatus::kRegulating);
  EXPECT_DOUBLE_EQ(cycle.result().gauge_pressure, -1000.0);
  cycle.Step(-2500.0);
  cycle.Step(-2500.0);
  EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
  EXPECT_EQ(cycle.result().gauge_pressure, -2500.0);
  cycle.Step(0.0);
  EXPECT_EQ(cycle.result().status, SealStatus::kRegulating);
  EXPECT_DOUBLE_EQ(cycle.result().gauge_pressure, -1500.0);
  cycle.Step(0.0);
  cycle.Step(0.0);
  EXPECT_EQ(cycle.result().status, SealStatus::kOpen);
  EXPECT_EQ(cycle.result().gauge_pressure, 0.0);
}

// Vented while it is pulled off: the lip opens before the ramp has ended, but nothing was lost.
TEST(Simulator, ADeliberateReleaseIsNoLoss) {
  GripCycle cycle(LoadBell("linear_700"), A20(0.01));
  cycle.Drive(kCupLength - 0.001, 0.01, 0.0, 0.1);
  cycle.Drive(kCupLength + 0.005, 0.02, -6000.0);
  EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
  for (double height = kCupLength + 0.005; height < kCupLength + 0.01; height += 0.0005) {
    cycle.Drive(height, 0.05, 0.0);
    EXPECT_NE(cycle.result().status, SealStatus::kLost);
  }
  EXPECT_EQ(cycle.result().status, SealStatus::kOpen);
}

TEST(Simulator, InTheAirSuctionHasNoEffect) {
  GripCycle cycle(LoadBell("linear_700"), A20(0.01));
  cycle.Drive(kCupLength + 0.005, 0.01, -6000.0, 0.05);
  EXPECT_EQ(cycle.result().status, SealStatus::kOpen);
  EXPECT_EQ(cycle.result().gauge_pressure, 0.0);
  EXPECT_LT(cycle.result().force_M.norm(), 1e-3);
}

// A tilted cup is pressed on one side: force and torque follow from the contacts.
TEST(Simulator, TiltedPressGivesATorque) {
  GripCycle cycle(LoadBell("linear_700"), A20(0.01));
  Eigen::Isometry3d X_WM = cycle.result().X_WM;
  const double tilt = 5.0 * M_PI / 180.0;
  for (int i = 1; i <= 40; ++i) {
    X_WM.linear() = Eigen::AngleAxisd(std::min(1.0, i / 20.0) * tilt, Eigen::Vector3d::UnitX()) *
                    Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    cycle.simulator().Step({X_WM, 0.0});
  }
  EXPECT_LT(cycle.result().force_M.z(), -0.05);
  EXPECT_GT(std::abs(cycle.result().torque_M.x()), 1e-3);
  EXPECT_NEAR(cycle.result().torque_M.y(), 0.0, 0.1 * std::abs(cycle.result().torque_M.x()));
  EXPECT_LE(cycle.result().max_penetration, 1e-6);
}

// A command a hall away and head over heels is one wild step, not the end: the cup finds its shape
// again.
TEST(Simulator, SurvivesATeleport) {
  GripCycle cycle(LoadBell("linear_700"), A20(0.01));
  const Eigen::Matrix3Xd rest = cycle.result().x_W;
  const Eigen::Isometry3d start = cycle.result().X_WM;
  Eigen::Isometry3d far = start;
  far.translation() += Eigen::Vector3d(0.1, -0.3, 0.5);
  far.linear() = Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitX()).toRotationMatrix() * far.linear();
  for (int i = 0; i < 60; ++i) {
    EXPECT_EQ(cycle.simulator().Step({far, 0.0}).outcome, StepOutcome::kOk);
  }
  const Eigen::Matrix3Xd expected = (far * start.inverse()) * rest;
  EXPECT_LT((cycle.result().x_W - expected).cwiseAbs().maxCoeff(), 1e-6);
}

// Far beyond what the material model is good for, every state is still finite and free of
// penetration.
TEST(Simulator, StaysFiniteUnderExtremeVacuumAndPress) {
  for (const double depth : {0.001, 0.009}) {
    GripCycle cycle(LoadBell("linear_700"), A20(0.01));
    cycle.Drive(kCupLength - depth, 0.02, 0.0, 0.05);
    cycle.Drive(kCupLength - depth, 0.02, -60000.0, 0.7);
    cycle.PullUntilLost(kCupLength + 0.02, 0.05, -60000.0, 0.1);
    EXPECT_EQ(cycle.undone_steps, 0);
    EXPECT_EQ(cycle.seal_flips, 2);
    EXPECT_LE(cycle.max_penetration, 1e-6);
    EXPECT_TRUE(cycle.result().x_W.allFinite());
  }
}

// A cavity may reach up to the mount, as around an inlet: its clamped points carry suction into the
// mount directly, and the balance holds.
TEST(Simulator, CavityMayShareNodesWithTheMount) {
  TetMesh mesh = LoadBell("linear_700");
  const int port =
      MakeCavitySurface(mesh).nodes[static_cast<std::size_t>(MakeCavitySurface(mesh).port.front())];
  mesh.mount_nodes.push_back(port);
  std::sort(mesh.mount_nodes.begin(), mesh.mount_nodes.end());
  GripCycle cycle(mesh, A20(0.01));
  cycle.Drive(kCupLength - 0.001, 0.01, 0.0, 0.1);
  cycle.Drive(kCupLength - 0.001, 0.01, -6000.0, 0.4);
  EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
  EXPECT_NEAR(cycle.result().force_M.z(),
              6000.0 * cycle.result().cavity_area - cycle.result().contact_force, 1e-4);
  EXPECT_EQ(cycle.undone_steps, 0);
}

// The plate that comes up to a resting cup presses it as the cup that comes down does.
TEST(Simulator, MovingSurfacePressesTheCup) {
  GripCycle down(LoadBell("linear_700"), A20(0.01));
  down.Drive(kCupLength - 0.001, 0.01, 0.0, 0.3);
  GripCycle up(LoadBell("linear_700"), A20(0.01));
  Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 50; ++i) {
    X_WO.translation().z() = std::min(0.0011, X_WO.translation().z() + 1e-4);
    up.simulator().SetObjectPose(0, X_WO);
    up.Step(0.0);
  }
  EXPECT_NEAR(up.result().force_M.z(), down.result().force_M.z(), 1e-5);
  EXPECT_THROW(up.simulator().SetObjectPose(1, X_WO), std::out_of_range);
  X_WO.translation().z() = kNan;
  EXPECT_THROW(up.simulator().SetObjectPose(0, X_WO), std::invalid_argument);
}

TEST(Simulator, RefusesBadParametersByName) {
  const auto expect_refused = [](const SimulatorParameters& parameters, const std::string& name) {
    try {
      Simulator(LoadBell("linear_700"), parameters);
      FAIL() << "accepted " << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  SimulatorParameters p = A20(0.01);
  p.time_step = 0.0;
  expect_refused(p, "time_step");
  p = A20(0.01);
  p.material.young_modulus = -1.0;
  expect_refused(p, "cup.young_modulus");
  p = A20(0.01);
  p.material.poisson_ratio = 0.5;
  expect_refused(p, "cup.poisson_ratio");
  p = A20(0.01);
  p.material.density = kNan;
  expect_refused(p, "cup.density");
  p = A20(0.01);
  p.seal.close_gap = 2e-4;
  p.seal.open_gap = 1e-4;
  expect_refused(p, "seal.open_gap");
  p = A20(0.01);
  p.contact.relaxation = 2.0;
  expect_refused(p, "contact.relaxation");
  p = A20(0.01);
  p.regulator.default_pressure = 100.0;
  expect_refused(p, "regulator.default_pressure");
  p = A20(0.01);
  p.gravity.y() = kNan;
  expect_refused(p, "gravity");
}

}  // namespace
}  // namespace vacuum_gripper_sim
