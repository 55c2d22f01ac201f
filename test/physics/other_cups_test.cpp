// Flat pad and bellows from their YAML files: sealed, held and pulled off.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "vacuum_gripper_sim/config/cup_file.h"
#include "vacuum_gripper_sim/core/cup_faces.h"
#include "vacuum_gripper_sim/core/gmsh_reader.h"
#include "vacuum_gripper_sim/core/self_contact.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {
namespace {

struct Case {
  const char* cup;
  double pressure;  // Pa
  double press;     // m
};

class OtherCupTest : public testing::TestWithParam<Case> {};

TEST_P(OtherCupTest, IsSealedHeldAndPulledOff) {
  const std::string cups = VACUUM_GRIPPER_SOURCE_DIR "/config/cups";
  const Cup cup = ReadCup(YAML::Node(GetParam().cup), cups, cups);
  const TetMesh mesh = ReadGmsh(cup.mesh_file);
  SimulatorParameters parameters;
  parameters.gravity.setZero();
  parameters.material = cup.material;
  parameters.damping = cup.damping;
  const double pressure = GetParam().pressure, h = parameters.time_step;

  const double length = mesh.nodes.row(2).maxCoeff();  // from lip to mount
  const auto pose_at = [&](double lip) {
    Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
    X_WM.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    X_WM.translation().z() = length + lip;
    return X_WM;
  };
  double lip = 1e-4;  // height of the lip of the cup at rest [m]
  Simulator simulator(mesh, parameters, pose_at(lip));
  simulator.SetObjects({FixedObject(RigidSurface{"plate", Plane{}})});
  CupFaces faces(mesh);
  const SelfContact self_contact(mesh, faces);

  int seal_flips = 0, undone_steps = 0;
  double max_penetration = 0.0, deepest_fold = 0.0, peak_force = 0.0;
  const auto holds = [&] {
    return simulator.result().status == SealStatus::kSealed ||
           simulator.result().status == SealStatus::kRegulating;
  };
  const auto step = [&](double speed, double setpoint) {
    const bool held = holds();
    lip += speed * h;
    const StepResult& result = simulator.Step({pose_at(lip), setpoint});
    seal_flips += holds() != held ? 1 : 0;
    undone_steps += result.outcome == StepOutcome::kOk ? 0 : 1;
    max_penetration = std::max(max_penetration, result.max_penetration);
    peak_force = std::max(peak_force, result.force_M.z());
    faces.Update(result.x_W);
    for (const FoldContact& fold : self_contact.Find(faces, result.x_W, 1e-3)) {
      deepest_fold = std::max(deepest_fold, -fold.gap);
    }
  };

  while (lip > -GetParam().press) step(-0.01, 0.0);
  for (int i = 0; i < 5; ++i) step(0.0, 0.0);
  EXPECT_LT(simulator.result().force_M.z(), 0.0);                  // pressed
  EXPECT_EQ(deepest_fold, 0.0);                                    // and no fold meets another
  const double ramp = -pressure / parameters.regulator.ramp_rate;  // s
  for (int i = 0; i < 35 + std::lround(ramp / h); ++i) step(0.0, pressure);
  EXPECT_EQ(simulator.result().status, SealStatus::kSealed);
  EXPECT_EQ(simulator.result().gauge_pressure, pressure);
  const double suction = -pressure * simulator.result().cavity_area;
  const double hold = simulator.result().force_M.z();
  EXPECT_NEAR(hold, suction - simulator.result().contact_force, 1e-3 * suction);

  peak_force = 0.0;
  while (lip < 0.02 && holds()) step(0.02, pressure);
  const double lift_at_loss = lip;
  EXPECT_EQ(simulator.result().status, SealStatus::kLost);
  for (int i = 0; i < 10; ++i) step(0.02, pressure);
  EXPECT_LT(std::abs(simulator.result().force_M.z()), 0.03 * peak_force);

  // The lip's circle seals at most: it is drawn inwards while the cup is pulled.
  constexpr double kLip = 0.012;  // m
  const double ideal = -pressure * M_PI * kLip * kLip;
  EXPECT_LT(peak_force, 1.02 * ideal);
  EXPECT_GT(peak_force, 0.6 * ideal);
  EXPECT_EQ(seal_flips, 2);
  EXPECT_EQ(undone_steps, 0);
  EXPECT_LE(max_penetration, 1e-6);
  std::printf(
      "%s at %.0f Pa: suction %.3f N, hold %.3f N, peak %.3f N = %.2f p A, lost at %.2f mm, "
      "folds pass by %.3f mm\n",
      GetParam().cup, pressure, suction, hold, peak_force, peak_force / ideal, 1e3 * lift_at_loss,
      1e3 * deepest_fold);
}

INSTANTIATE_TEST_SUITE_P(
    Cups, OtherCupTest,
    testing::Values(Case{"flat_25_linear", -20000.0, 5e-4}, Case{"flat_25_linear", -60000.0, 5e-4},
                    Case{"flat_25", -20000.0, 5e-4}, Case{"bellows_25_linear", -6000.0, 1e-3},
                    Case{"bellows_25_linear", -20000.0, 1e-3}, Case{"bellows_25", -20000.0, 1e-3}),
    [](const auto& info) {
      return info.param.cup + std::string("_at_") +
             std::to_string(std::lround(-info.param.pressure)) + "_Pa";
    });

}  // namespace
}  // namespace vacuum_gripper_sim
