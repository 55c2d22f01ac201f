#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "grip_cycle.h"
#include "grip_world.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kSetpoint = -6000.0;  // Pa

SimulatorParameters WithCups(const std::vector<Eigen::Vector3d>& places) {
  SimulatorParameters parameters = A20(0.01);
  parameters.cups.clear();
  for (const Eigen::Vector3d& p_MC : places) {
    CupMount cup;
    cup.name = "cup_" + std::to_string(parameters.cups.size());
    cup.X_MC.translation() = p_MC;
    parameters.cups.push_back(cup);
  }
  return parameters;
}

GripCycle PressedAndPulled(const SimulatorParameters& parameters) {
  GripCycle cycle(LoadBell("linear_700"), parameters);
  cycle.Drive(kCupLength - 0.5e-3, 0.02, 0.0, 0.2);
  cycle.Drive(kCupLength - 0.5e-3, 0.02, kSetpoint, 0.3);
  cycle.Drive(kCupLength + 1e-3, 0.02, kSetpoint, 0.3);
  return cycle;
}

TEST(CupArray, EveryCupIsTheSingleOne) {
  const GripCycle single = PressedAndPulled(A20(0.01));
  const Eigen::Vector3d p_0(0.05, 0.0, 0.0), p_1(-0.03, 0.04, 0.0);
  const GripCycle both = PressedAndPulled(WithCups({p_0, p_1}));
  const CupResult& alone = single.result().cups[0];
  ASSERT_EQ(alone.status, SealStatus::kSealed);
  ASSERT_EQ(both.result().cups.size(), 2U);
  for (const CupResult& cup : both.result().cups) {
    EXPECT_EQ(cup.status, SealStatus::kSealed);
    EXPECT_LT((cup.force_C - alone.force_C).norm(), 1e-6);
    EXPECT_LT((cup.torque_C - alone.torque_C).norm(), 1e-8);
    EXPECT_NEAR(cup.cavity_area, alone.cavity_area, 1e-10);
    EXPECT_NEAR(cup.cavity_volume, alone.cavity_volume, 1e-12);
    EXPECT_NEAR(cup.contact_force, alone.contact_force, 1e-6);
    EXPECT_EQ(cup.zone_counts, alone.zone_counts);
  }
  // The gripper's own are the sums.
  const StepResult& sum = both.result();
  EXPECT_LT((sum.force_M - 2.0 * alone.force_C).norm(), 2e-6);
  const Eigen::Vector3d torque_M = 2.0 * alone.torque_C + (p_0 + p_1).cross(alone.force_C);
  EXPECT_LT((sum.torque_M - torque_M).norm(), 1e-7);
  EXPECT_NEAR(sum.contact_force, 2.0 * alone.contact_force, 2e-6);
  EXPECT_EQ(sum.status, SealStatus::kSealed);
  EXPECT_EQ(both.undone_steps, 0);
}

TEST(CupArray, ACupBesideTheObjectStaysOpenAndTheOtherHolds) {
  const auto pose_at = [](double height) {
    Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
    X_WM.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    X_WM.translation().z() = height;
    return X_WM;
  };
  Simulator simulator(LoadBell("linear_700"), WithCups({{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}}),
                      pose_at(kCupLength + 1e-4));
  RigidSurface box{"box", Box{{0.06, 0.06, 0.02}}};
  box.X_FS.translation().z() = -0.01;
  simulator.SetObjects({FixedObject(box)});
  double height = kCupLength;
  for (; height > kCupLength - 0.5e-3; height -= 1e-4) simulator.Step({pose_at(height), 0.0});
  for (int i = 0; i < 30; ++i) simulator.Step({pose_at(height), kSetpoint});
  const StepResult& result = simulator.result();
  EXPECT_EQ(result.cups[0].status, SealStatus::kSealed);
  EXPECT_EQ(result.cups[1].status, SealStatus::kOpen);
  EXPECT_EQ(result.cups[1].gauge_pressure, 0.0);
  EXPECT_EQ(result.cups[1].num_contacts, 0U);
  EXPECT_EQ(result.status, SealStatus::kSealed);
  EXPECT_GT(result.bottleneck_gap, 0.01);  // of the open one

  for (; result.cups[0].status == SealStatus::kSealed && height < kCupLength + 0.02;) {
    height += 2e-4;
    simulator.Step({pose_at(height), kSetpoint});
  }
  EXPECT_EQ(result.cups[0].status, SealStatus::kLost);
  EXPECT_EQ(result.cups[1].status, SealStatus::kOpen);
  EXPECT_EQ(result.status, SealStatus::kLost);
}

/// A free box, with friction, that four cups press on a table, take hold of and begin to lift.
ObjectResult BoxHeldByFour(ContactSolverMethod method) {
  SimulatorParameters parameters = WithGravity(
      WithCups({{0.03, 0.02, 0.0}, {-0.03, 0.02, 0.0}, {0.03, -0.02, 0.0}, {-0.03, -0.02, 0.0}}));
  parameters.contact.method = method;
  if (method == ContactSolverMethod::kGaussSeidel) parameters.contact.max_iterations = 200000;
  GripWorld world({Table(0.5), FreeBox({0.12, 0.1, 0.02}, 0.2, 0.5, {0.004, 0.002, 0.01})},
                  {0.0, 0.0, 0.02 + kCupLength + 1e-4}, parameters);
  world.MoveTo({0.0, 0.0, 0.02 + kCupLength - 3e-4}, 0.02, 0.0);
  world.Wait(0.02, kSetpoint);
  world.MoveTo({0.0, 0.0, 0.02 + kCupLength}, 0.02, kSetpoint);
  EXPECT_EQ(world.undone_steps, 0);
  EXPECT_TRUE(Holds(world.result()));
  EXPECT_EQ(world.result().cups.size(), 4U);
  return world.object(1);
}

// Newton's method, cup by cup, and Gauss-Seidel, contact by contact.
TEST(CupArray, BoxHeldByFourMovesTheSameWhateverTheSolver) {
  const ObjectResult newton = BoxHeldByFour(ContactSolverMethod::kActiveSet);
  const ObjectResult sweeps = BoxHeldByFour(ContactSolverMethod::kGaussSeidel);
  EXPECT_GT(newton.X_WO.translation().z(), 0.0105);  // off the table
  EXPECT_LT((newton.X_WO.translation() - sweeps.X_WO.translation()).norm(), 1e-7);
  EXPECT_TRUE(newton.X_WO.linear().isApprox(sweeps.X_WO.linear(), 1e-6));
  EXPECT_LT((newton.force_W - sweeps.force_W).norm(), 1e-3 * newton.force_W.norm());
}

TEST(CupArray, RefusesCupsWithoutNamesOrPoses) {
  const auto expect_refused = [](const SimulatorParameters& parameters, const std::string& field) {
    try {
      Validate(parameters);
      FAIL() << "must refuse " << field;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  SimulatorParameters parameters = WithCups({});
  expect_refused(parameters, "cups");
  parameters = WithCups({Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()});
  parameters.cups[1].name = parameters.cups[0].name;
  expect_refused(parameters, "cups[1].name");
  parameters.cups[1].name = "";
  expect_refused(parameters, "cups[1].name");
  parameters.cups[1].name = "left";
  parameters.cups[1].X_MC.linear() *= 2.0;
  expect_refused(parameters, "cups[1].X_MC");
}

}  // namespace
}  // namespace vacuum_gripper_sim
