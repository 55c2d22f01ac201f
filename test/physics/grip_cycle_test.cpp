// Press, hold, pull and lose: what must be so at every pressure and for both element orders.
#include "physics/grip_cycle.h"

#include <gtest/gtest.h>

#include <map>

#include "vacuum_gripper_sim/core/elastic_body.h"

namespace vacuum_gripper_sim {
namespace {

/// A bell of a material.
struct Bell {
  const char* title;
  const char* mesh;
  double poisson_ratio;
  MaterialModel model;
};

class GripCycleTest : public testing::TestWithParam<Bell> {};

TEST_P(GripCycleTest, SealsOnceAndLosesOnceAtEveryPressure) {
  double last_hold = 0.0;
  for (const double pressure : {-2000.0, -4000.0, -6000.0, -8000.0, -10000.0}) {
    SCOPED_TRACE(pressure);
    SimulatorParameters parameters = A20(0.01);
    parameters.material.poisson_ratio = GetParam().poisson_ratio;
    parameters.material.model = GetParam().model;
    GripCycle cycle(LoadBell(GetParam().mesh), parameters);
    cycle.Drive(kCupLength - 0.001, 0.01, 0.0, 0.1);
    EXPECT_EQ(cycle.result().status, SealStatus::kOpen);
    EXPECT_LT(cycle.result().force_M.z(), 0.0);  // pressed

    cycle.Drive(kCupLength - 0.001, 0.01, pressure, 0.3);
    EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
    EXPECT_EQ(cycle.result().gauge_pressure, pressure);
    const double hold = cycle.result().force_M.z();
    EXPECT_GT(hold, last_hold);
    last_hold = hold;

    cycle.PullUntilLost(kCupLength + 0.014, 0.005, pressure, 0.1);
    EXPECT_EQ(cycle.result().status, SealStatus::kLost);
    EXPECT_EQ(cycle.result().gauge_pressure, 0.0);
    EXPECT_LT(std::abs(cycle.result().force_M.z()), 0.02 * cycle.peak_force);
    EXPECT_EQ(cycle.seal_flips, 2);
    EXPECT_EQ(cycle.undone_steps, 0);
    EXPECT_LE(cycle.max_penetration, 1e-6);
    RecordProperty("hold_N", std::to_string(hold));
    std::printf("%s at %.0f Pa: hold %.3f N, peak %.3f N, lost at %.2f mm\n", GetParam().title,
                pressure, hold, cycle.peak_force, 1e3 * cycle.lift_at_loss);

    cycle.Step(0.0);
    EXPECT_EQ(cycle.result().status, SealStatus::kOpen);  // a set-point of zero ends the grip
  }
}

INSTANTIATE_TEST_SUITE_P(
    Bells, GripCycleTest,
    testing::Values(Bell{"linear_700", "linear_700", 0.45, MaterialModel::kCorotational},
                    Bell{"quadratic_700", "quadratic_700", 0.45, MaterialModel::kCorotational},
                    Bell{"linear_700_nh", "linear_700", 0.45, MaterialModel::kNeoHookean},
                    Bell{"quadratic_700_nh", "quadratic_700", 0.45, MaterialModel::kNeoHookean},
                    Bell{"quadratic_700_nh_nearly_incompressible", "quadratic_700", 0.499,
                         MaterialModel::kNeoHookean}),
    [](const auto& info) { return std::string(info.param.title); });

TEST(GripCycle, TwoRunsAreBitIdentical) {
  std::vector<Eigen::Matrix3Xd> ends;
  std::vector<Eigen::Vector3d> forces;
  for (int run = 0; run < 2; ++run) {
    GripCycle cycle(LoadBell("linear_700"), A20(0.01));
    cycle.Drive(kCupLength - 0.001, 0.01, 0.0, 0.05);
    cycle.Drive(kCupLength + 0.002, 0.01, -6000.0);
    ends.push_back(cycle.result().x_W);
    forces.push_back(cycle.result().force_M);
  }
  EXPECT_EQ(ends[0], ends[1]);
  EXPECT_EQ(forces[0], forces[1]);
}

// Suction pulls the cup down, the contacts and the mount hold it: -(weight + contacts + pressure).
TEST(GripCycle, WrenchBalancesWeightContactsAndPressureAtRest) {
  for (const char* const bell : {"linear_700", "quadratic_700"}) {
    SimulatorParameters parameters = A20(0.01);
    parameters.gravity = Eigen::Vector3d(0.0, 0.0, -9.81);
    GripCycle cycle(LoadBell(bell), parameters);
    const ElasticBody body(cycle.simulator().mesh(), parameters.material);
    const double weight = body.weights().sum() * 9.81;

    cycle.Drive(kCupLength + 5e-4, 0.01, 0.0, 0.3);  // in the air
    EXPECT_NEAR(cycle.result().force_M.z(), weight, 1e-6);
    EXPECT_NEAR(cycle.result().torque_M.norm(), 0.0, 1e-6);
    const double hanging = cycle.result().force_M.z();

    cycle.Drive(kCupLength - 0.001, 0.01, 0.0, 0.3);  // pressed
    EXPECT_NEAR(cycle.result().force_M.z(), hanging - cycle.result().contact_force, 1e-4);

    cycle.Drive(kCupLength - 0.001, 0.01, -6000.0, 0.5);  // sealed
    EXPECT_NEAR(cycle.result().force_M.z(),
                hanging - cycle.result().contact_force + 6000.0 * cycle.result().cavity_area, 1e-4)
        << bell;
  }
}

// A settled state knows nothing of the time step that led to it.
TEST(GripCycle, SettledForceDoesNotDependOnTheTimeStep) {
  std::map<std::string, double> reference;
  for (const double h : {0.001, 0.002, 0.005, 0.01}) {
    GripCycle cycle(LoadBell("linear_700"), A20(h));
    cycle.Drive(kCupLength - 0.001, 0.01, 0.0, 0.4);
    const double pressed = cycle.result().force_M.z();
    cycle.Drive(kCupLength - 0.001, 0.01, -6000.0, 0.6);
    const double sealed = cycle.result().force_M.z();
    cycle.Drive(kCupLength + 0.002, 0.01, -6000.0, 0.6);
    const double pulled = cycle.result().force_M.z();
    for (const auto& [name, force] :
         {std::pair{"pressed", pressed}, {"sealed", sealed}, {"pulled", pulled}}) {
      const double expected = reference.try_emplace(name, force).first->second;
      EXPECT_NEAR(force, expected, 1e-3 * std::abs(expected)) << name << ", h = " << h;
    }
  }
}

// Gravity, plate and cup turned and moved together: the same forces in the cup's own frame.
TEST(GripCycle, NothingDependsOnTheWorldsFrame) {
  Eigen::Isometry3d X_AW = Eigen::Isometry3d::Identity();
  X_AW.linear() = Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.3, -1.0, 0.6).normalized()).matrix();
  X_AW.translation() = Eigen::Vector3d(0.4, -0.2, 0.9);
  SimulatorParameters parameters = A20(0.01);
  parameters.gravity = Eigen::Vector3d(0.0, 0.0, -9.81);
  GripCycle upright(LoadBell("linear_700"), parameters);
  GripCycle turned(LoadBell("linear_700"), parameters, X_AW);
  const auto compare = [&](const char* phase) {
    const double scale = upright.result().force_M.norm();
    EXPECT_LT((turned.result().force_M - upright.result().force_M).norm(), 1e-6 * scale) << phase;
    EXPECT_LT((turned.result().torque_M - upright.result().torque_M).norm(), 1e-6 * scale * 0.02)
        << phase;
    EXPECT_LT((turned.result().x_W - X_AW * upright.result().x_W).cwiseAbs().maxCoeff(), 1e-8)
        << phase;
    EXPECT_EQ(turned.result().status, upright.result().status) << phase;
  };
  for (GripCycle* cycle : {&upright, &turned}) cycle->Drive(kCupLength - 0.001, 0.01, 0.0, 0.1);
  compare("pressed");
  for (GripCycle* cycle : {&upright, &turned}) cycle->Drive(kCupLength, 0.01, -6000.0, 0.2);
  compare("sealed");
  for (GripCycle* cycle : {&upright, &turned}) cycle->Drive(kCupLength + 0.003, 0.01, -6000.0);
  compare("pulled");
}

}  // namespace
}  // namespace vacuum_gripper_sim
