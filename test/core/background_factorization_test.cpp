// Factorisations on a second thread: the solver that takes them, and the thread itself.
#include "vacuum_gripper_sim/core/background_factorization.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "support/bending_block.h"
#include "vacuum_gripper_sim/core/delassus_operator.h"
#include "vacuum_gripper_sim/core/linear_solver.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kTimeStep = BendingBlock::kTimeStep;
const std::vector<std::vector<NodeColumn>> kNoContacts{{}};

TEST(LinearSolver, TakesWhatTheSecondThreadFinished) {
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kAsynchronous), block.system());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(block.size(), -1.0, 1.0);
  ASSERT_TRUE(solver.Compute());
  solver.FactorizeAhead(kNoContacts, kTimeStep);
  EXPECT_TRUE(solver.current());  // nothing to wait for yet: its own
  for (double slope = 0.05; solver.generation() < 4; slope = -slope) {
    block.Bend(slope);
    ASSERT_TRUE(solver.Compute());
    EXPECT_FALSE(solver.current());
    EXPECT_EQ(solver.factorizations(), 0);
    EXPECT_LT((block.Dense() * Solve(b, block.system(), &solver) - b).norm(), 2e-10 * b.norm());
    solver.FactorizeAhead(kNoContacts, kTimeStep);
    std::this_thread::yield();
  }
}

/// Steps on until the second thread's factorisation is taken, with these contacts' W.
void FactorizeAndTake(const std::vector<std::vector<NodeColumn>>& contacts, BendingBlock* block,
                      LinearSolver* solver) {
  int generation = 0;
  double slope = 0.05;
  do {
    solver->FactorizeAhead(contacts, kTimeStep);
    generation = solver->generation();
    block->Bend(slope);
    slope = -slope;
    ASSERT_TRUE(solver->Compute());
    Solve(Eigen::VectorXd::Ones(block->size()), block->system(), solver);
    std::this_thread::yield();
  } while (solver->generation() == generation || solver->factorizations() > 0);
}

TEST(LinearSolver, HasWOfContactsMadeAlongWithAFactorisation) {
  const std::vector<NodeColumn> contacts{{3, Eigen::Vector3d::UnitZ()},
                                         {7, Eigen::Vector3d::UnitX()}};
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kAsynchronous), block.system());
  EXPECT_EQ(solver.TakePrepared(), nullptr);
  ASSERT_TRUE(solver.Compute());
  EXPECT_EQ(solver.TakePrepared(), nullptr);  // its own factorisation comes without
  FactorizeAndTake({contacts}, &block, &solver);
  const auto* const prepared = solver.TakePrepared();
  ASSERT_NE(prepared, nullptr);
  ASSERT_EQ(prepared->size(), 1U);
  DelassusOperator here;
  here.Reset(solver.factorization(), kTimeStep);
  here.SetRows(contacts);
  EXPECT_EQ(Eigen::MatrixXd(prepared->front().W()), Eigen::MatrixXd(here.W()));
}

// Else it would be that of another factorisation or of other contacts.
TEST(LinearSolver, HasPreparedWOnceAndForItsFactorisationAlone) {
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kAsynchronous), block.system());
  ASSERT_TRUE(solver.Compute());
  FactorizeAndTake(kNoContacts, &block, &solver);
  EXPECT_NE(solver.TakePrepared(), nullptr);
  EXPECT_EQ(solver.TakePrepared(), nullptr);

  FactorizeAndTake(kNoContacts, &block, &solver);
  ASSERT_TRUE(solver.Renew());
  EXPECT_EQ(solver.TakePrepared(), nullptr);

  FactorizeAndTake(kNoContacts, &block, &solver);
  solver.FactorizeAhead(kNoContacts, kTimeStep);
  EXPECT_EQ(solver.TakePrepared(), nullptr);
}

TEST(LinearSolver, HasNobodyToFactorizeAheadOnOneThread) {
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kConjugateGradient), block.system());
  ASSERT_TRUE(solver.Compute());
  EXPECT_FALSE(solver.MayFactorizeAhead());
  solver.FactorizeAhead(kNoContacts, kTimeStep);
  EXPECT_EQ(solver.TakePrepared(), nullptr);
}

BackgroundFactorization::Status WaitFor(const BackgroundFactorization& background) {
  while (background.status() == BackgroundFactorization::Status::kBusy) std::this_thread::yield();
  return background.status();
}

TEST(BackgroundFactorization, DoesWhatThisThreadWould) {
  BendingBlock block;
  block.Linearize();
  SparseCholesky here;
  here.Analyze(block.A());
  BackgroundFactorization background(here, block.system()->matrix(), Precision::kDouble);
  EXPECT_EQ(background.status(), BackgroundFactorization::Status::kIdle);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(block.size());
  std::vector<NodeColumn> contacts;
  for (int round = 0; round < 3; ++round) {
    block.Bend(0.1);
    contacts.push_back({5 * round, Eigen::Vector3d(0.1, 0.2, 1.0)});
    background.Start(block.system()->linearization(), {contacts}, kTimeStep);
    ASSERT_TRUE(here.Factorize(block.A()));
    DelassusOperator W;
    W.Reset(here, kTimeStep);
    W.SetRows(contacts);
    ASSERT_EQ(WaitFor(background), BackgroundFactorization::Status::kDone);
    const auto* const there = background.Finish();
    ASSERT_NE(there, nullptr);
    EXPECT_EQ(there->factorization.Solve(b), here.Solve(b));
    EXPECT_EQ(Eigen::MatrixXd(there->W.front().W()), Eigen::MatrixXd(W.W()));
    EXPECT_EQ(background.status(), BackgroundFactorization::Status::kIdle);
  }
  Linearization indefinite = block.system()->linearization();
  indefinite.mass_factor = -1e3;
  background.Start(indefinite, kNoContacts, kTimeStep);
  WaitFor(background);
  EXPECT_EQ(background.Finish(), nullptr);
  // It goes on; and ends while it works.
  background.Start(block.system()->linearization(), kNoContacts, kTimeStep);
}

}  // namespace
}  // namespace vacuum_gripper_sim
