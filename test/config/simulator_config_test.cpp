#include "vacuum_gripper_sim/config/simulator_config.h"

#include <gtest/gtest.h>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

SimulatorParameters Read(const std::string& yaml) {
  ParameterReader reader(YAML::Load(yaml));
  const SimulatorParameters parameters = ReadSimulatorParameters(&reader);
  reader.CheckNoUnknownKeys();
  return parameters;
}

TEST(SimulatorConfig, NothingSetGivesTheDefaults) {
  const SimulatorParameters read = Read("{}");
  const SimulatorParameters expected;
  EXPECT_EQ(read.gravity, expected.gravity);
  EXPECT_EQ(read.linear_solver.method, expected.linear_solver.method);
  EXPECT_EQ(read.linear_solver.precision, expected.linear_solver.precision);
  EXPECT_EQ(read.contact.method, expected.contact.method);
  EXPECT_EQ(read.contact.tolerance, expected.contact.tolerance);
  EXPECT_EQ(read.seal.open_gap, expected.seal.open_gap);
  EXPECT_EQ(read.regulator.min_pressure, expected.regulator.min_pressure);
  ASSERT_EQ(read.cups.size(), 1U);
  EXPECT_EQ(read.cups[0].name, "");
}

TEST(SimulatorConfig, ReadsEveryKey) {
  const SimulatorParameters p = Read(R"(
gravity: [1.0, 2.0, 3.0]
linear_solver: {method: conjugate_gradient, precision: double, tolerance: 0.1,
                position_tolerance: 2.0e-6, max_iterations: 2, refactor_interval: 3, threads: 4}
contact: {solver: gauss_seidel, tolerance: 0.4, acceptable_residual: 0.45, max_iterations: 5,
          relaxation: 1.6, alarm_distance: 0.7}
seal: {close_gap: 0.8, open_gap: 0.9, max_rounds: 10, ramp_increments: 11}
regulator: {default_pressure: -12.0, min_pressure: -13.0, ramp_rate: 14.0}
cups: [{name: a, position: [0.15, 0.16, 0.17]}]
)");
  EXPECT_EQ(p.gravity, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(p.linear_solver.method, LinearSolverMethod::kConjugateGradient);
  EXPECT_EQ(p.linear_solver.precision, Precision::kDouble);
  EXPECT_EQ(p.linear_solver.tolerance, 0.1);
  EXPECT_EQ(p.linear_solver.position_tolerance, 2e-6);
  EXPECT_EQ(p.linear_solver.max_iterations, 2);
  EXPECT_EQ(p.linear_solver.refactor_interval, 3);
  EXPECT_EQ(p.linear_solver.threads, 4);
  EXPECT_EQ(p.contact.method, ContactSolverMethod::kGaussSeidel);
  EXPECT_EQ(p.contact.tolerance, 0.4);
  EXPECT_EQ(p.contact.acceptable_residual, 0.45);
  EXPECT_EQ(p.contact.max_iterations, 5);
  EXPECT_EQ(p.contact.relaxation, 1.6);
  EXPECT_EQ(p.contact.alarm_distance, 0.7);
  EXPECT_EQ(p.seal.close_gap, 0.8);
  EXPECT_EQ(p.seal.open_gap, 0.9);
  EXPECT_EQ(p.seal.max_rounds, 10);
  EXPECT_EQ(p.seal.ramp_increments, 11);
  EXPECT_EQ(p.regulator.default_pressure, -12.0);
  EXPECT_EQ(p.regulator.min_pressure, -13.0);
  EXPECT_EQ(p.regulator.ramp_rate, 14.0);
  ASSERT_EQ(p.cups.size(), 1U);
  EXPECT_EQ(p.cups[0].X_MC.translation(), Eigen::Vector3d(0.15, 0.16, 0.17));
}

TEST(SimulatorConfig, RefusalsNameTheDottedPath) {
  EXPECT_TRUE(Contains(ErrorOf([] { Read("contact: {solver: magic}"); }),
                       "contact.solver = magic; expected active_set or gauss_seidel"));
  EXPECT_TRUE(Contains(ErrorOf([] { Read("seal: {max_rounds: 1.5}"); }), "seal.max_rounds = 1.5"));
  EXPECT_TRUE(Contains(ErrorOf([] { Read("linear_solver: {methode: direct}"); }),
                       "linear_solver.methode is not a known key"));
  EXPECT_TRUE(Contains(ErrorOf([] { Read("regulator: -6000.0"); }), "regulator = -6000.0"));
  EXPECT_TRUE(Contains(ErrorOf([] { Read("cups:"); }), "cups = (empty); expected a list"));
}

TEST(SimulatorConfig, KnowsEveryLinearSolver) {
  using Method = LinearSolverMethod;
  EXPECT_EQ(Read("linear_solver: {method: direct}").linear_solver.method, Method::kDirect);
  EXPECT_EQ(Read("linear_solver: {method: conjugate_gradient}").linear_solver.method,
            Method::kConjugateGradient);
  EXPECT_EQ(Read("linear_solver: {method: asynchronous}").linear_solver.method,
            Method::kAsynchronous);
}

}  // namespace
}  // namespace vacuum_gripper_sim
