#include "vacuum_gripper_sim/core/mcp_solver.h"

#include <gtest/gtest.h>

#include <random>

namespace vacuum_gripper_sim {
namespace {

ContactParameters Exact(ContactSolverMethod method) {
  ContactParameters parameters;
  parameters.method = method;
  parameters.tolerance = 1e-13;
  parameters.max_iterations = 200000;
  return parameters;
}

class McpSolverTest : public testing::TestWithParam<ContactSolverMethod> {};

// Two contacts coupled through one body. With delta = (-3, -1) mm and W = [2 1; 1 2] mm/N the
// system W lambda = -delta gives (5/3, -1/3) N, a pull at the second contact. Without it lambda =
// (3/2, 0) N, and its gap opens to -1 + 3/2 = 1/2 mm.
TEST_P(McpSolverTest, DropsThePullingContact) {
  Eigen::Matrix2d W;
  W << 2e-3, 1e-3, 1e-3, 2e-3;
  const Eigen::Vector2d delta(-3e-3, -1e-3);
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(2);
  const McpStatistics statistics = McpSolver().Solve(W, delta, Exact(GetParam()), &lambda);
  EXPECT_TRUE(statistics.converged);
  EXPECT_NEAR(lambda(0), 1.5, 1e-9);
  EXPECT_EQ(lambda(1), 0.0);
  EXPECT_NEAR((delta + W * lambda)(1), 0.5e-3, 1e-12);
}

// One contact: lambda = -delta / W when penetrating, 0 when open.
TEST_P(McpSolverTest, OneContact) {
  const Eigen::MatrixXd W = Eigen::MatrixXd::Constant(1, 1, 4e-3);
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(1);
  McpSolver().Solve(W, Eigen::VectorXd::Constant(1, -2e-3), Exact(GetParam()), &lambda);
  EXPECT_NEAR(lambda(0), 0.5, 1e-10);
  McpSolver().Solve(W, Eigen::VectorXd::Constant(1, 2e-3), Exact(GetParam()), &lambda);
  EXPECT_EQ(lambda(0), 0.0);
}

// The same contact twice: W is singular; the sum of the forces is what one would carry.
TEST_P(McpSolverTest, SharesADoubledContact) {
  const Eigen::MatrixXd W = Eigen::MatrixXd::Constant(2, 2, 1e-3);
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(2);
  const McpStatistics statistics =
      McpSolver().Solve(W, Eigen::VectorXd::Constant(2, -1e-3), Exact(GetParam()), &lambda);
  EXPECT_TRUE(statistics.converged);
  EXPECT_NEAR(lambda.sum(), 1.0, 1e-9);
  EXPECT_GE(lambda.minCoeff(), 0.0);
}

TEST_P(McpSolverTest, NoContactsIsConverged) {
  Eigen::VectorXd lambda(0);
  const McpStatistics statistics =
      McpSolver().Solve(Eigen::MatrixXd(0, 0), Eigen::VectorXd(0), Exact(GetParam()), &lambda);
  EXPECT_TRUE(statistics.converged);
  EXPECT_EQ(statistics.residual, 0.0);
}

TEST_P(McpSolverTest, ReportsWhatItDidNotReach) {
  Eigen::Matrix2d W;
  W << 2e-3, 1.9e-3, 1.9e-3, 2e-3;
  ContactParameters parameters = Exact(GetParam());
  parameters.max_iterations = 1;
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(2);
  const McpStatistics statistics =
      McpSolver().Solve(W, Eigen::Vector2d(-1e-3, -3e-3), parameters, &lambda);
  EXPECT_FALSE(statistics.converged);
  EXPECT_EQ(statistics.iterations, 1);
  EXPECT_GT(statistics.residual, 1e-6);
  EXPECT_GE(lambda.minCoeff(), 0.0);
}

TEST_P(McpSolverTest, RejectsSizeMismatch) {
  Eigen::VectorXd lambda(3);
  EXPECT_THROW(McpSolver().Solve(Eigen::Matrix2d::Identity(), Eigen::Vector2d::Zero(),
                                 Exact(GetParam()), &lambda),
               std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Methods, McpSolverTest,
                         testing::Values(ContactSolverMethod::kGaussSeidel,
                                         ContactSolverMethod::kActiveSet),
                         [](const auto& info) {
                           return info.param == ContactSolverMethod::kActiveSet ? "ActiveSet"
                                                                                : "GaussSeidel";
                         });

// W = B B^T + I / 20 in mm/N: random, coupled, well enough conditioned for Gauss-Seidel to finish.
Eigen::MatrixXd RandomDelassus(int size, std::mt19937* random) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd B =
      Eigen::MatrixXd::NullaryExpr(size, size, [&]() { return normal(*random); });
  return 1e-3 * (B * B.transpose() / size + 0.05 * Eigen::MatrixXd::Identity(size, size));
}

TEST(McpSolver, SolversAgreeOnRandomProblems) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (const int size : {1, 2, 3, 5, 10, 30, 100, 300}) {
    for (int repeat = 0; repeat < 5; ++repeat) {
      const Eigen::MatrixXd W = RandomDelassus(size, &random);
      const Eigen::VectorXd delta =
          Eigen::VectorXd::NullaryExpr(size, [&]() { return 1e-3 * normal(random); });
      Eigen::VectorXd by_active_set = Eigen::VectorXd::Zero(size);
      Eigen::VectorXd by_gauss_seidel = Eigen::VectorXd::Zero(size);
      const McpStatistics statistics =
          McpSolver().Solve(W, delta, Exact(ContactSolverMethod::kActiveSet), &by_active_set);
      ASSERT_TRUE(statistics.converged) << size;
      ASSERT_TRUE(McpSolver()
                      .Solve(W, delta, Exact(ContactSolverMethod::kGaussSeidel), &by_gauss_seidel)
                      .converged)
          << size;
      EXPECT_LT((by_active_set - by_gauss_seidel).cwiseAbs().maxCoeff(),
                1e-4 * by_active_set.cwiseAbs().maxCoeff() + 1e-12);

      // The warm start of the solution itself needs one look.
      EXPECT_EQ(McpSolver()
                    .Solve(W, delta, Exact(ContactSolverMethod::kActiveSet), &by_active_set)
                    .iterations,
                1);
    }
  }
}

// Over-relaxation changes the way, not the solution.
TEST(McpSolver, RelaxationDoesNotChangeTheSolution) {
  std::mt19937 random(5);
  const Eigen::MatrixXd W = RandomDelassus(40, &random);
  const Eigen::VectorXd delta = Eigen::VectorXd::LinSpaced(40, -1e-3, 0.5e-3);
  Eigen::VectorXd reference = Eigen::VectorXd::Zero(40);
  McpSolver().Solve(W, delta, Exact(ContactSolverMethod::kActiveSet), &reference);
  for (const double relaxation : {0.7, 1.3, 1.7}) {
    ContactParameters parameters = Exact(ContactSolverMethod::kGaussSeidel);
    parameters.relaxation = relaxation;
    Eigen::VectorXd lambda = Eigen::VectorXd::Zero(40);
    EXPECT_TRUE(McpSolver().Solve(W, delta, parameters, &lambda).converged);
    EXPECT_LT((lambda - reference).cwiseAbs().maxCoeff(), 1e-6 * reference.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
