#include "vacuum_gripper_sim/core/friction_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// As a single group, which moves nothing but itself.
ContactCompliance Alone(const MatrixXd& W) {
  return {{{0, W}}, ContactCompliance::RowMajorMatrix(W.rows(), 0)};
}

struct Problem {
  MatrixXd W;
  VectorXd delta;
  std::vector<ContactRows> rows;
};

/// `num_contacts` coupled contacts, about half of them closed.
Problem RandomProblem(int num_contacts, double friction, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const Index size = 3 * num_contacts;
  const MatrixXd B = MatrixXd::NullaryExpr(size, size, [&] { return normal(generator); });
  Problem problem;
  problem.W = 1e-4 / static_cast<double>(size) * B * B.transpose();
  problem.W.diagonal().array() += 1e-5;
  problem.delta = 1e-3 * VectorXd::NullaryExpr(size, [&] { return normal(generator); });
  for (int i = 0; i < num_contacts; ++i) problem.rows.push_back({3 * i, friction});
  return problem;
}

/// Checks the law of Coulomb and the complementarity of gap and force themselves.
void ExpectSolved(const Problem& problem, const VectorXd& lambda, double tolerance) {
  const VectorXd end = problem.delta + problem.W * lambda;
  for (const ContactRows& contact : problem.rows) {
    const Index n = contact.normal;
    EXPECT_GE(end(n), -tolerance);
    EXPECT_GE(lambda(n), 0.0);
    EXPECT_LE(std::min(end(n), lambda(n) * problem.W(n, n)), tolerance);
    const Eigen::Vector2d force = lambda.segment<2>(contact.tangent());
    const Eigen::Vector2d slip = end.segment<2>(contact.tangent());
    const double limit = contact.friction * lambda(n);
    const double force_tolerance = tolerance / problem.W(n + 1, n + 1);
    EXPECT_LE(force.norm(), limit + 2.0 * force_tolerance);
    if (slip.norm() > 10.0 * tolerance) {
      EXPECT_LT((force + limit * slip.normalized()).norm(), 1e-3 * limit + 10.0 * force_tolerance);
    }
  }
}

TEST(FrictionSolver, BlockOnAPlaneSticksAndSlides) {
  Problem problem;
  problem.W = 1e-3 * MatrixXd::Identity(3, 3);  // [m/N]
  problem.rows = {{0, 0.5}};
  ContactParameters parameters;
  for (const double pushed : {0.4, 0.6}) {  // of the normal force, which is 2 N
    problem.delta.resize(3);
    problem.delta << -2e-3, pushed * 2e-3, 0.0;
    VectorXd lambda = VectorXd::Zero(3);
    EXPECT_TRUE(FrictionSolver()
                    .Solve(Alone(problem.W), problem.delta, problem.rows, parameters, &lambda)
                    .converged);
    EXPECT_NEAR(lambda(0), 2.0, 1e-6);
    EXPECT_NEAR(lambda(1), pushed < 0.5 ? -0.8 : -1.0, 1e-6);
    EXPECT_NEAR(lambda(2), 0.0, 1e-6);
  }
}

TEST(FrictionSolver, BothMethodsSatisfyTheLaws) {
  for (const double friction : {0.1, 0.5, 0.9}) {
    for (unsigned seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE(friction);
      SCOPED_TRACE(seed);
      const Problem problem = RandomProblem(20, friction, seed);
      ContactParameters parameters;
      VectorXd newton = VectorXd::Zero(60);
      const McpStatistics statistics = FrictionSolver().Solve(Alone(problem.W), problem.delta,
                                                              problem.rows, parameters, &newton);
      EXPECT_TRUE(statistics.converged);
      EXPECT_LE(statistics.iterations, 20);
      ExpectSolved(problem, newton, 1e-9);

      parameters.method = ContactSolverMethod::kGaussSeidel;
      parameters.max_iterations = 10000;
      VectorXd sweeps = VectorXd::Zero(60);
      EXPECT_TRUE(FrictionSolver()
                      .Solve(Alone(problem.W), problem.delta, problem.rows, parameters, &sweeps)
                      .converged);
      ExpectSolved(problem, sweeps, 1e-9);
      EXPECT_LT((newton - sweeps).norm(), 1e-3 * newton.norm());
    }
  }
}

TEST(FrictionSolver, FrictionlessContactsAreThoseOfTheFrictionlessSolver) {
  Problem problem = RandomProblem(20, 0.0, 3);
  problem.rows.clear();
  for (Index i = 0; i < 60; ++i) problem.rows.push_back({i, 0.0});
  VectorXd with = VectorXd::Zero(60);
  VectorXd without = VectorXd::Zero(60);
  ContactCompliance coupled = Alone(problem.W);
  coupled.U.setZero(60, 1);  // keeps it from McpSolver
  FrictionSolver().Solve(coupled, problem.delta, problem.rows, ContactParameters(), &with);
  McpSolver().Solve(problem.W, problem.delta, ContactParameters(), &without);
  EXPECT_LT((with - without).norm(), 1e-6 * without.norm());
}

// Four corners of a block have twelve forces for six ways to move.
TEST(FrictionSolver, MoreForcesThanWaysToMove) {
  MatrixXd J = MatrixXd::Zero(12, 6);
  Problem problem;
  for (int corner = 0; corner < 4; ++corner) {
    const Eigen::Vector3d arm((corner & 1) != 0 ? 0.03 : -0.03, (corner & 2) != 0 ? 0.02 : -0.02,
                              -0.01);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d d = Eigen::Vector3d::Unit((axis + 2) % 3);  // z, x, y
      J.block<1, 3>(3 * corner + axis, 0) = d.transpose();
      J.block<1, 3>(3 * corner + axis, 3) = arm.cross(d).transpose();
    }
    problem.rows.push_back({3 * corner, 0.5});
  }
  Eigen::Matrix<double, 6, 1> compliance;  // h^2 M^-1
  compliance << 1e-3, 1e-3, 1e-3, 2.0, 2.0, 2.0;
  problem.W = J * compliance.asDiagonal() * J.transpose();
  // Its weight of 1 N and a push of .3 N: it stays.
  Eigen::Matrix<double, 6, 1> push;
  push << 0.3, 0.0, -1.0, 0.0, 0.0, 0.0;
  problem.delta = J * compliance.asDiagonal() * push;
  VectorXd lambda = VectorXd::Zero(12);
  EXPECT_TRUE(
      FrictionSolver()
          .Solve(Alone(problem.W), problem.delta, problem.rows, ContactParameters(), &lambda)
          .converged);
  EXPECT_LT((J.transpose() * lambda + push).norm(), 1e-5);
  ExpectSolved(problem, lambda, 1e-9);
}

/// Three groups of random contacts, listed in turns, the last one's stiff as those between bodies
/// are; coupled by `ways` of bodies.
struct Groups {
  Groups(Index ways, double friction, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    const Problem random[3] = {RandomProblem(12, friction, seed + 1),
                               RandomProblem(8, friction, seed + 2),
                               RandomProblem(2, friction, seed + 3)};
    Index first = 0;
    for (const Problem& of_group : random) {
      W.groups.push_back({first, of_group.W});
      first += of_group.W.rows();
    }
    W.groups[2].C = 1e-7 * MatrixXd(W.groups[2].C.diagonal().asDiagonal());
    W.U = 3e-3 * MatrixXd::NullaryExpr(first, ways, [&] { return normal(generator); });
    delta.resize(first);
    delta << random[0].delta, random[1].delta, random[2].delta;
    for (Index contact = 0; contact < 12; ++contact) {
      for (const ContactCompliance::Group& group : W.groups) {
        if (3 * contact < group.size()) rows.push_back({group.first + 3 * contact, friction});
      }
    }
    dense.W = W.U * W.U.transpose();
    for (const ContactCompliance::Group& group : W.groups) {
      dense.W.block(group.first, group.first, group.size(), group.size()) += group.C;
    }
    dense.delta = delta;
    dense.rows = rows;
  }

  ContactCompliance W;
  VectorXd delta;
  std::vector<ContactRows> rows;
  Problem dense;  // the same
};

TEST(FrictionSolver, CoupledGroupsAreTheDenseProblem) {
  for (const ContactSolverMethod method :
       {ContactSolverMethod::kActiveSet, ContactSolverMethod::kGaussSeidel}) {
    for (const double friction : {0.2, 0.6}) {
      for (unsigned seed = 0; seed < 5; ++seed) {
        SCOPED_TRACE(seed);
        const Groups problem(12, friction, 10 * seed);
        ContactParameters parameters;
        parameters.method = method;
        parameters.tolerance = 1e-11;
        parameters.max_iterations = 100000;
        VectorXd dense = VectorXd::Zero(problem.delta.size());
        VectorXd grouped = dense;
        EXPECT_TRUE(
            FrictionSolver()
                .Solve(Alone(problem.dense.W), problem.delta, problem.rows, parameters, &dense)
                .converged);
        EXPECT_TRUE(FrictionSolver()
                        .Solve(problem.W, problem.delta, problem.rows, parameters, &grouped)
                        .converged);
        ExpectSolved(problem.dense, grouped, 1e-10);
        EXPECT_LT((grouped - dense).norm(), 1e-5 * dense.norm());
      }
    }
  }
}

TEST(FrictionSolver, GroupsThatNothingCouplesAreSolvedOneByOne) {
  for (const double friction : {0.0, 0.5}) {
    Groups problem(0, 0.5, 7);
    if (friction == 0.0) {
      problem.rows.clear();
      for (Index i = 0; i < problem.delta.size(); ++i) problem.rows.push_back({i, 0.0});
    }
    VectorXd together = VectorXd::Zero(problem.delta.size());
    const McpStatistics statistics = FrictionSolver().Solve(problem.W, problem.delta, problem.rows,
                                                            ContactParameters(), &together);
    int iterations = 0;
    for (const ContactCompliance::Group& group : problem.W.groups) {
      const VectorXd delta = problem.delta.segment(group.first, group.size());
      std::vector<ContactRows> rows;
      for (Index i = 0; i<group.size(); i += friction> 0.0 ? 3 : 1) rows.push_back({i, friction});
      VectorXd one = VectorXd::Zero(group.size());
      const McpStatistics of_one =
          FrictionSolver().Solve(Alone(group.C), delta, rows, ContactParameters(), &one);
      EXPECT_TRUE(of_one.converged);
      EXPECT_EQ(one, VectorXd(together.segment(group.first, group.size())));
      iterations = std::max(iterations, of_one.iterations);
    }
    EXPECT_TRUE(statistics.converged);
    EXPECT_EQ(statistics.iterations, iterations);
  }
}

TEST(FrictionSolver, RefusesRowsThatDoNotCoverW) {
  VectorXd lambda = VectorXd::Zero(3);
  EXPECT_THROW(FrictionSolver().Solve(Alone(MatrixXd::Identity(3, 3)), VectorXd::Zero(3),
                                      {{0, 0.0}}, ContactParameters(), &lambda),
               std::invalid_argument);
}

}  // namespace
}  // namespace vacuum_gripper_sim
