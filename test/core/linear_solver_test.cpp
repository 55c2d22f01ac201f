#include "vacuum_gripper_sim/core/linear_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <vector>

#include "support/bending_block.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kTimeStep = BendingBlock::kTimeStep;

// For three steps, as they all need iterations.
TEST(LinearSolver, ReusesAFactorisationForSomeSteps) {
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kConjugateGradient), block.system());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(block.size(), -1.0, 1.0);
  int generation = 0;
  for (const bool expected : {true, false, false, true, false}) {
    block.Bend(0.02);
    ASSERT_TRUE(solver.Compute());
    EXPECT_EQ(solver.current(), expected);
    EXPECT_EQ(solver.factorizations(), expected ? 1 : 0);
    generation += expected ? 1 : 0;
    EXPECT_EQ(solver.generation(), generation);
    const Eigen::VectorXd dv = Solve(b, block.system(), &solver);
    EXPECT_LT((block.Dense() * dv - b).norm(), 2e-10 * b.norm());
    EXPECT_EQ(solver.iterations() > 0, !expected);
  }
}

TEST(LinearSolver, HasItsThreadsShareAFactorisation) {
  BendingBlock block;
  block.Linearize();
  LinearSolverParameters parameters = SolverParametersWith(LinearSolverMethod::kDirect);
  EXPECT_EQ(LinearSolver(parameters, block.system()).factorization().num_branches(), 1);
  parameters.threads = 3;
  EXPECT_GT(LinearSolver(parameters, block.system()).factorization().num_branches(), 1);
}

// Where a step needs no iterations the old factorisation is as good as a new one.
TEST(LinearSolver, KeepsAFactorisationThatNeedsNoIterations) {
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kConjugateGradient), block.system());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(block.size(), -1.0, 1.0);
  for (int step = 0; step < 12; ++step) {
    ASSERT_TRUE(solver.Compute());
    EXPECT_EQ(solver.old(), step > 0);
    Solve(b, block.system(), &solver);
    EXPECT_EQ(solver.iterations(), 0);
  }
  EXPECT_EQ(solver.generation(), 1);
}

// From a multiple of the solution on nothing is left to solve; from elsewhere less than before.
TEST(LinearSolver, StartsFromTheMultipleOfAGuess) {
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kConjugateGradient), block.system());
  ASSERT_TRUE(solver.Compute());
  const Touching nothing(*block.system(), solver, {});
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(block.size(), -1.0, 1.0);
  const Eigen::VectorXd solution = solver.factorization().Solve(b);

  SystemVector dv{0.3 * solution, Eigen::VectorXd(0)};
  SystemVector rest{b, Eigen::VectorXd(0)};
  solver.Start(nothing.constraints(), &dv, &rest);
  EXPECT_LT((dv.cup - solution).norm(), 1e-9 * solution.norm());
  EXPECT_LT(rest.norm(), 1e-9 * b.norm());

  dv.cup = solution + Eigen::VectorXd::Constant(block.size(), 0.1 * solution.maxCoeff());
  rest.cup = b;
  solver.Start(nothing.constraints(), &dv, &rest);
  EXPECT_LT((block.Dense() * dv.cup + rest.cup - b).norm(), 1e-12 * b.norm());
  const Eigen::VectorXd error = dv.cup - solution;
  EXPECT_LT(error.dot(block.Dense() * error), solution.dot(b));

  dv.SetZero(block.size(), 0);
  rest.cup = b;
  solver.Start(nothing.constraints(), &dv, &rest);
  EXPECT_EQ(dv.norm(), 0.0);
  EXPECT_EQ(rest.cup, b);
}

// Against the dense saddle-point system, from forces and a motion that keep the held gaps; to a
// residual, or to a last correction of a motion of some millimetres.
class HeldContacts : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(LinearSolver, HeldContacts, testing::Bool(), [](const auto& info) {
  return info.param ? "ToACorrection" : "ToAResidual";
});
TEST_P(HeldContacts, KeepTheirGaps) {
  BendingBlock block;
  block.Linearize();
  LinearSolverParameters parameters =
      SolverParametersWith(LinearSolverMethod::kConjugateGradient, 10);
  if (GetParam()) {
    parameters.tolerance = 1e-15;
    parameters.position_tolerance = 1e-10;
  }
  LinearSolver solver(parameters, block.system());
  ASSERT_TRUE(solver.Compute());
  block.Bend(0.03);
  ASSERT_TRUE(solver.Compute());
  ASSERT_FALSE(solver.current());

  const auto size = block.size();
  const std::vector<int> nodes{3, 11, 20, 37};
  const std::vector<Eigen::Index> held{0, 2, 3};
  std::vector<NodeColumn> H_rows;
  Eigen::MatrixXd hH_held = Eigen::MatrixXd::Zero(3, size);
  for (const int node : nodes) H_rows.push_back({node, Eigen::Vector3d(0.1, 0.2, 1.0)});
  for (Eigen::Index i = 0; i < 3; ++i) {
    const NodeColumn& row = H_rows[static_cast<std::size_t>(held[static_cast<std::size_t>(i)])];
    hH_held.block<1, 3>(i, 3 * row.node) = kTimeStep * row.value.transpose();
  }
  const Touching touching(*block.system(), solver, H_rows);

  Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(size, -1e-3, 1e-3);
  SystemVector motion{Eigen::VectorXd::Zero(size), Eigen::VectorXd(0)};
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(4);
  lambda(1) = 0.5;  // not held: a given force
  ASSERT_TRUE(
      solver.Refine({b, Eigen::VectorXd(0)}, touching.constraints(), held, &motion, &lambda));
  const Eigen::VectorXd& dv = motion.cup;
  EXPECT_EQ(lambda(1), 0.5);
  EXPECT_GT(solver.iterations(), 1);

  b.segment<3>(3 * nodes[1]) += kTimeStep * 0.5 * H_rows[1].value;
  Eigen::MatrixXd saddle = Eigen::MatrixXd::Zero(size + 3, size + 3);
  saddle.topLeftCorner(size, size) = block.Dense();
  saddle.topRightCorner(size, 3) = -hH_held.transpose();
  saddle.bottomLeftCorner(3, size) = hH_held;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size + 3);
  right.head(size) = b;
  const Eigen::VectorXd expected = saddle.fullPivLu().solve(right);
  EXPECT_LT((dv - expected.head(size)).norm(), 1e-7 * expected.head(size).norm());
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(lambda(held[static_cast<std::size_t>(i)]), expected(size + i),
                1e-7 * expected.tail(3).norm());
  }
}

// A motion of 1 mm: what is left after the last correction is less than that, and the coarser the
// tolerance the fewer iterations.
TEST(LinearSolver, EndsWithACorrectionThatMovesNothingFar) {
  int iterations_before = 100;
  for (const double tolerance : {1e-11, 1e-8, 1e-5}) {
    BendingBlock block;
    block.Linearize();
    LinearSolverParameters parameters =
        SolverParametersWith(LinearSolverMethod::kConjugateGradient);
    parameters.tolerance = 1e-15;  // out of reach
    parameters.position_tolerance = tolerance;
    LinearSolver solver(parameters, block.system());
    ASSERT_TRUE(solver.Compute());
    block.Bend(0.03);
    ASSERT_TRUE(solver.Compute());
    ASSERT_TRUE(solver.old());
    Eigen::VectorXd expected =
        block.Dense().ldlt().solve(Eigen::VectorXd::LinSpaced(block.size(), -1.0, 1.0));
    expected *= 1e-3 / (kTimeStep * expected.cwiseAbs().maxCoeff());
    const Eigen::VectorXd dv = Solve(block.Dense() * expected, block.system(), &solver);
    EXPECT_LT(kTimeStep * (dv - expected).cwiseAbs().maxCoeff(), tolerance);
    EXPECT_LT(solver.iterations(), iterations_before);
    iterations_before = solver.iterations();
  }
  EXPECT_GE(iterations_before, 1);
}

// A thin plate that has turned is up to some tens of times softer across than its old
// factorisation, and a correction by that as much too small: it is not taken for the last one. The
// plate's end moves by 1 um.
TEST(LinearSolver, AFactorisationThatIsTooStiffMakesNoSmallCorrections) {
  int num_converged = 0;
  for (const double angle : {0.001, 0.003, 0.01, 0.03, 0.1}) {
    BendingBlock plate(MakeBlock(20, 4, 1, {0.02, 0.01, 0.001}, true));
    plate.Linearize();
    LinearSolverParameters parameters =
        SolverParametersWith(LinearSolverMethod::kConjugateGradient, 1000, 200);
    parameters.precision = Precision::kSingle;
    parameters.position_tolerance = 1e-8;
    LinearSolver solver(parameters, plate.system());
    ASSERT_TRUE(solver.Compute());
    plate.Turn(angle);
    ASSERT_TRUE(solver.Compute());
    ASSERT_TRUE(solver.old());
    SparseCholesky exact;
    exact.Analyze(plate.A());
    ASSERT_TRUE(exact.Factorize(plate.A()));
    Eigen::VectorXd b = Eigen::VectorXd::Zero(plate.size());
    for (Eigen::Index z = 2; z < b.size(); z += 3) b(z) = 1.0;
    Eigen::VectorXd expected = exact.Solve(b);
    const double scale = 1e-7 / (kTimeStep * expected.cwiseAbs().maxCoeff());
    expected *= scale;
    b *= scale;
    const Touching nothing(*plate.system(), solver, {});
    SystemVector dv{solver.factorization().Solve(b), Eigen::VectorXd(0)};
    Eigen::VectorXd no_forces(0);
    const bool converged =
        solver.Refine({b, Eigen::VectorXd(0)}, nothing.constraints(), {}, &dv, &no_forces);
    const double error = kTimeStep * (dv.cup - expected).cwiseAbs().maxCoeff();
    EXPECT_TRUE(!converged || error < 1e-8) << angle << " rad: " << error;
    num_converged += converged ? 1 : 0;
  }
  EXPECT_GE(num_converged, 2);
}

// Too few iterations allowed: it says so, and a new factorisation makes it good.
TEST(LinearSolver, GivesUpWhereAFactorisationIsTooOld) {
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kConjugateGradient, 1000, 3),
                      block.system());
  ASSERT_TRUE(solver.Compute());
  block.Turn(1.0);
  ASSERT_TRUE(solver.Compute());
  ASSERT_FALSE(solver.current());
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(block.size());
  const Touching nothing(*block.system(), solver, {});
  SystemVector dv{Eigen::VectorXd::Zero(b.size()), Eigen::VectorXd(0)};
  Eigen::VectorXd no_forces(0);
  EXPECT_FALSE(solver.Refine({b, Eigen::VectorXd(0)}, nothing.constraints(), {}, &dv, &no_forces));
  EXPECT_LE(solver.iterations(), 3);
  ASSERT_TRUE(solver.Renew());
  EXPECT_TRUE(solver.current());
  EXPECT_LT((block.Dense() * Solve(b, block.system(), &solver) - b).norm(), 1e-9 * b.norm());
}

// In vain once, twice, ...: 1, 3, 7, 7 steps without a try; after a good one it begins anew.
TEST(LinearSolver, TriesLessOftenTheLongerItIsInVain) {
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kConjugateGradient, 1000, 3),
                      block.system());
  ASSERT_TRUE(solver.Compute());
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(block.size());
  const auto step = [&](double angle) {
    block.Turn(angle);
    EXPECT_TRUE(solver.Compute());
    if (!solver.old()) return false;
    const Touching nothing(*block.system(), solver, {});
    SystemVector dv{solver.factorization().Solve(b), Eigen::VectorXd(0)};
    Eigen::VectorXd no_forces(0);
    if (!solver.Refine({b, Eigen::VectorXd(0)}, nothing.constraints(), {}, &dv, &no_forces)) {
      EXPECT_TRUE(solver.Renew());
    }
    return true;
  };
  for (const int pause : {1, 3, 7, 7}) {
    EXPECT_TRUE(step(1.0));
    for (int i = 0; i < pause; ++i) EXPECT_FALSE(step(1.0)) << pause;
  }
  EXPECT_TRUE(step(0.0));
  EXPECT_TRUE(step(1.0));
  EXPECT_FALSE(step(1.0));
  EXPECT_TRUE(step(0.0));
}

// What an earlier solve of the same step took is not held against the next.
TEST(LinearSolver, EverySolveOfAStepHasItsOwnIterations) {
  BendingBlock block;
  block.Linearize();
  LinearSolver solver(SolverParametersWith(LinearSolverMethod::kConjugateGradient, 1000, 12),
                      block.system());
  ASSERT_TRUE(solver.Compute());
  block.Bend(0.03);
  ASSERT_TRUE(solver.Compute());
  for (int solve = 1; solve <= 4; ++solve) {
    Solve(Eigen::VectorXd::Random(block.size()), block.system(), &solver);  // expects an end
    EXPECT_GT(solver.iterations(), 3 * solve);
  }
  EXPECT_GT(solver.iterations(), 12);
}

// A single-precision factor is never exact, and renewing it makes one that is.
TEST(LinearSolver, IterationsMakeUpForSinglePrecision) {
  BendingBlock block;
  block.Linearize();
  LinearSolverParameters parameters = SolverParametersWith(LinearSolverMethod::kDirect);
  parameters.precision = Precision::kSingle;
  LinearSolver solver(parameters, block.system());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(block.size(), -1.0, 1.0);
  for (int step = 0; step < 3; ++step) {
    block.Bend(0.05);
    ASSERT_TRUE(solver.Compute());
    EXPECT_FALSE(solver.current());
    EXPECT_EQ(solver.factorizations(), 1);
    EXPECT_EQ(solver.factorization().precision(), Precision::kSingle);
    EXPECT_LT((block.Dense() * Solve(b, block.system(), &solver) - b).norm(), 2e-10 * b.norm());
    EXPECT_GT(solver.iterations(), 0);
    EXPECT_LE(solver.iterations(), 4);
  }
  ASSERT_TRUE(solver.Renew());
  EXPECT_TRUE(solver.current());
  EXPECT_EQ(solver.factorizations(), 2);
  EXPECT_LT((block.Dense() * Solve(b, block.system(), &solver) - b).norm(), 1e-9 * b.norm());
}

}  // namespace
}  // namespace vacuum_gripper_sim
