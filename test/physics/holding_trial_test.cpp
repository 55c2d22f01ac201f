#include "vacuum_gripper_sim/core/holding_trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grip_cycle.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSetpoint = -6000.0;  // Pa
constexpr double kSlow = 0.005;        // of the real failure; trials go four times as fast [m/s]

Isometry3d PoseAt(double height) {
  Isometry3d X_WM = Isometry3d::Identity();
  X_WM.linear() = Vector3d(1.0, -1.0, -1.0).asDiagonal();
  X_WM.translation().z() = height;
  return X_WM;
}

/// A cup that holds a plate.
class HoldingTrialTest : public testing::TestWithParam<VacuumSourceType> {
 protected:
  HoldingTrialTest() : mesh_(LoadBell("linear_700")), parameters_(Parameters()) {}

  static SimulatorParameters Parameters() {
    SimulatorParameters parameters = A20(0.01);
    parameters.vacuum.source = GetParam();
    parameters.vacuum.regulator.time_constant = 0.01;
    return parameters;
  }

  Simulator Gripping(double friction) {
    Simulator simulator(mesh_, parameters_, PoseAt(kCupLength + 1e-4));
    RigidSurface plate{"plate", Plane{}};
    plate.friction = friction;
    plate.roughness = 5e-6;
    simulator.SetObjects({FixedObject(plate)});
    double height = kCupLength;
    for (; height > kCupLength - 0.5e-3; height -= 2e-4) simulator.Step({PoseAt(height), 0.0});
    for (int i = 0; i < 40; ++i) simulator.Step({PoseAt(height), kSetpoint});
    height_ = height;
    return simulator;
  }

  TetMesh mesh_;
  SimulatorParameters parameters_;
  double height_{0.0};
};

TEST_P(HoldingTrialTest, PullFailsWhereTheMarginSays) {
  Simulator simulator = Gripping(0.0);
  HoldingTrial trial(mesh_, parameters_);
  for (const double height : {height_, height_ + 2e-3, height_ + 4e-3}) {
    while (simulator.result().X_WM.translation().z() < height - 1e-9) {
      simulator.Step(
          {PoseAt(simulator.result().X_WM.translation().z() + kSlow * parameters_.time_step),
           kSetpoint});
    }
    const HoldingReserve margin = trial.Measure(simulator.Save());
    ASSERT_TRUE(margin.holds);
    const double now = simulator.result().force_M.z();
    Simulator real(mesh_, parameters_);
    real.Restore(simulator.Save());
    double most = now;
    for (double z = height; z < height + 0.03 && real.result().status != SealStatus::kLost;) {
      z += kSlow * parameters_.time_step;
      real.Step({PoseAt(z), kSetpoint});
      most = std::max(most, real.result().force_M.z());
    }
    EXPECT_EQ(real.result().status, SealStatus::kLost);
    EXPECT_GT(margin.normal_force, 0.3);
    EXPECT_NEAR(now + margin.normal_force, most, 0.05 * most) << height;
  }
}

TEST_P(HoldingTrialTest, ShearEndsAtTheConeOfFriction) {
  constexpr double kFriction = 0.3;
  Simulator simulator = Gripping(kFriction);
  HoldingTrial trial(mesh_, parameters_);
  const HoldingReserve margin = trial.Measure(simulator.Save());
  ASSERT_TRUE(margin.holds);
  // Contacts carry the suction less the pull on the mount.
  EXPECT_NEAR(margin.shear_force, kFriction * simulator.result().contact_force,
              0.1 * margin.shear_force);
  Simulator slippery = Gripping(0.0);
  EXPECT_LT(trial.Measure(slippery.Save()).shear_force, 0.02 * margin.shear_force);
}

TEST_P(HoldingTrialTest, TiltFailsWhereTheMarginSays) {
  Simulator simulator = Gripping(0.5);
  HoldingTrial trial(mesh_, parameters_);
  const HoldingReserve margin = trial.Measure(simulator.Save());
  ASSERT_TRUE(margin.holds);
  Simulator real(mesh_, parameters_);
  real.Restore(simulator.Save());
  Vector3d rim_W = Vector3d::Zero();
  const CavitySurface& cavity = simulator.cavity();
  for (const int point : cavity.border) {
    rim_W += simulator.result().x_W.col(cavity.nodes[static_cast<std::size_t>(point)]) /
             static_cast<double>(cavity.border.size());
  }
  double most = 0.0;
  for (double angle = 0.0; angle < 0.8 && real.result().status != SealStatus::kLost;) {
    angle += 0.25 * parameters_.time_step;
    Isometry3d X_WM = PoseAt(height_);
    X_WM.pretranslate(-rim_W);
    X_WM.prerotate(Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix());
    X_WM.pretranslate(rim_W);
    real.Step({X_WM, kSetpoint});
    const Vector3d force_W = X_WM.linear() * real.result().force_M;
    const Vector3d torque_W =
        X_WM.linear() * real.result().torque_M + (X_WM.translation() - rim_W).cross(force_W);
    if (Holds(real.result())) most = std::max(most, std::abs(torque_W.x()));
  }
  EXPECT_GT(margin.tilting_moment, 0.005);
  EXPECT_NEAR(margin.tilting_moment, most, 0.1 * most);
}

TEST_P(HoldingTrialTest, NothingHeldHasNoMargin) {
  Simulator simulator(mesh_, parameters_, PoseAt(kCupLength + 0.05));
  simulator.SetObjects({FixedObject(RigidSurface{"plate", Plane{}})});
  simulator.Step({PoseAt(kCupLength + 0.05), kSetpoint});
  const HoldingReserve margin = HoldingTrial(mesh_, parameters_).Measure(simulator.Save());
  EXPECT_FALSE(margin.holds);
  EXPECT_EQ(margin.normal_force, 0.0);
  EXPECT_EQ(margin.shear_force, 0.0);
  EXPECT_EQ(margin.tilting_moment, 0.0);
}

TEST_P(HoldingTrialTest, ARestoredMomentGoesOnAsTheOriginal) {
  Simulator simulator = Gripping(0.0);
  Simulator copy(mesh_, parameters_);
  copy.Restore(simulator.Save());
  for (int i = 1; i <= 20; ++i) {
    const Command command{PoseAt(height_ + 5e-5 * i), kSetpoint};
    simulator.Step(command);
    copy.Step(command);
    EXPECT_LT((simulator.result().x_W - copy.result().x_W).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_NEAR(simulator.result().force_M.z(), copy.result().force_M.z(), 1e-3);
    EXPECT_EQ(simulator.result().status, copy.result().status);
  }
  Simulator other(LoadBell("quadratic_700"), parameters_);
  EXPECT_THROW(other.Restore(simulator.Save()), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Sources, HoldingTrialTest,
                         testing::Values(VacuumSourceType::kIdealRegulator,
                                         VacuumSourceType::kRegulator),
                         [](const auto& info) {
                           return info.param == VacuumSourceType::kIdealRegulator ? "Ideal"
                                                                                  : "Regulator";
                         });

}  // namespace
}  // namespace vacuum_gripper_sim
