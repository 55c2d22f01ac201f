#include "vacuum_gripper_sim/core/sparse_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <random>
#include <set>
#include <utility>

#include "support/block_mesh.h"
#include "support/node_matrices.h"
#include "vacuum_gripper_sim/core/elastic_body.h"

namespace vacuum_gripper_sim {
namespace {

/// K + mass of a block: what stepping factorises.
NodeMatrix StepMatrix(int cells, bool quadratic) {
  const TetMesh mesh = MakeBlock(cells, cells + 1, cells, {0.02, 0.03, 0.01}, quadratic);
  const ElasticBody body(mesh, {338000.0, 0.45, 1080.0});
  Eigen::SparseMatrix<double> A = body.Stiffness(mesh.nodes);
  for (int i = 0; i < A.cols(); ++i) A.coeffRef(i, i) += 10.0 + 0.1 * i;
  return MakeNodeMatrix(A.triangularView<Eigen::Lower>());
}

/// Columns at random nodes, some of them twice.
std::vector<NodeColumn> RandomColumns(int num_nodes, int num_columns, unsigned int seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::uniform_int_distribution<int> node(0, num_nodes - 1);
  std::vector<NodeColumn> columns(static_cast<std::size_t>(num_columns));
  for (NodeColumn& column : columns) {
    column = {node(random), {uniform(random), uniform(random), uniform(random)}};
  }
  return columns;
}

EliminatedColumns Eliminated(const std::vector<NodeColumn>& B, const SparseCholesky& cholesky) {
  EliminatedColumns Y;
  cholesky.EliminateColumns(B, &Y);
  return Y;
}

Eigen::MatrixXd Gram(const EliminatedColumns& Y) {
  Eigen::MatrixXd gram(Y.num_columns(), Y.num_columns());
  Y.Gram(gram);
  return gram;
}

TEST(SparseCholesky, SolvesLikeADenseFactorisation) {
  for (const bool quadratic : {false, true}) {
    for (const int cells : {1, 2, 4}) {
      const NodeMatrix A = StepMatrix(cells, quadratic);
      SparseCholesky cholesky;
      cholesky.Analyze(A);
      ASSERT_TRUE(cholesky.Factorize(A));
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3 * A.num_nodes, -1.0, 2.0);
      const Eigen::VectorXd expected = Dense(A).llt().solve(b);
      EXPECT_LT((cholesky.Solve(b) - expected).norm(), 1e-11 * expected.norm());

      // New values in the old structure.
      NodeMatrix doubled = A;
      for (NodeBlock& block : doubled.values) block *= 2.0;
      ASSERT_TRUE(cholesky.Factorize(doubled));
      EXPECT_LT((cholesky.Solve(b) - 0.5 * expected).norm(), 1e-11 * expected.norm());
    }
  }
}

// Single precision by request, and double again after it.
TEST(SparseCholesky, PrecisionIsChosenByFactorisation) {
  const NodeMatrix A = StepMatrix(3, true);
  SparseCholesky cholesky;
  cholesky.Analyze(A);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3 * A.num_nodes, -1.0, 2.0);
  const Eigen::VectorXd expected = Dense(A).llt().solve(b);
  const auto columns = RandomColumns(A.num_nodes, 30, 5);
  ASSERT_TRUE(cholesky.Factorize(A));
  const Eigen::MatrixXd W = Gram(Eliminated(columns, cholesky));
  for (const Precision precision : {Precision::kSingle, Precision::kDouble}) {
    ASSERT_TRUE(cholesky.Factorize(A, precision));
    EXPECT_EQ(cholesky.precision(), precision);
    const double share = precision == Precision::kSingle ? 1e-3 : 1e-11;
    const double error = (cholesky.Solve(b) - expected).norm() / expected.norm();
    EXPECT_LT(error, share);
    const double W_error = (Gram(Eliminated(columns, cholesky)) - W).norm() / W.norm();
    EXPECT_LT(W_error, share);
    EXPECT_EQ(error > 1e-10, precision == Precision::kSingle);
  }
}

// Separate bodies are separate trees.
TEST(SparseCholesky, HandlesAForest) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < 12; ++i) entries.emplace_back(i, i, 2.0 + i);
  entries.emplace_back(4, 1, 0.5);
  Eigen::SparseMatrix<double> lower(12, 12);
  lower.setFromTriplets(entries.begin(), entries.end());
  const NodeMatrix A = MakeNodeMatrix(lower);
  SparseCholesky cholesky;
  cholesky.Analyze(A);
  ASSERT_TRUE(cholesky.Factorize(A));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(12);
  EXPECT_LT((Dense(A) * cholesky.Solve(b) - b).norm(), 1e-14);
  // Nodes 0 and 1 are one piece, 2 and 3 one each.
  EXPECT_EQ(cholesky.num_pieces(), 3);
  EXPECT_EQ(cholesky.PieceOf(0), cholesky.PieceOf(1));
  EXPECT_EQ((std::set<int>{cholesky.PieceOf(1), cholesky.PieceOf(2), cholesky.PieceOf(3)}),
            (std::set<int>{0, 1, 2}));
}

Eigen::MatrixXd Dense(const std::vector<NodeColumn>& columns, Eigen::Index num_rows) {
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(num_rows, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    B.block<3, 1>(3 * columns[c].node, static_cast<Eigen::Index>(c)) = columns[c].value;
  }
  return B;
}

TEST(SparseCholesky, EliminatedColumnsAreHalfOfTheInverse) {
  const NodeMatrix A = StepMatrix(3, true);
  SparseCholesky cholesky;
  cholesky.Analyze(A);
  ASSERT_TRUE(cholesky.Factorize(A));
  const Eigen::MatrixXd inverse =
      Dense(A).llt().solve(Eigen::MatrixXd::Identity(3 * A.num_nodes, 3 * A.num_nodes));
  const auto first = RandomColumns(A.num_nodes, 40, 3);
  const auto second = RandomColumns(A.num_nodes, 7, 4);
  const Eigen::MatrixXd B = Dense(first, 3 * A.num_nodes);
  const Eigen::MatrixXd C = Dense(second, 3 * A.num_nodes);
  const EliminatedColumns Y = Eliminated(first, cholesky);
  const EliminatedColumns Z = Eliminated(second, cholesky);

  const Eigen::MatrixXd gram = B.transpose() * inverse * B;
  EXPECT_LT((Gram(Y) - gram).norm(), 1e-12 * gram.norm());
  EXPECT_EQ(Gram(Y), Gram(Y).transpose());
  const Eigen::MatrixXd product = B.transpose() * inverse * C;
  Eigen::MatrixXd Y_Z(Y.num_columns(), Z.num_columns());
  Y.TransposeTimes(Z, Y_Z);
  EXPECT_LT((Y_Z - product).norm(), 1e-12 * product.norm());

  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3 * A.num_nodes, -1.0, 2.0);
  const Eigen::VectorXd seen = B.transpose() * inverse * b;
  Eigen::VectorXd y, Y_y(Y.num_columns());
  cholesky.Eliminate(b, &y);
  Y.TransposeTimes(y, Y_y);
  EXPECT_LT((Y_y - seen).norm(), 1e-12 * seen.norm());
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(40, -1.0, 1.0);
  y.setZero();
  Y.AddTimes(2.0, x, &y);
  Eigen::VectorXd solved;
  cholesky.BackSubstitute(y, &solved);
  const Eigen::VectorXd moved = 2.0 * inverse * B * x;
  EXPECT_LT((solved - moved).norm(), 1e-12 * moved.norm());
}

// The same operations, whoever does them.
TEST(SparseCholesky, ACrewMakesTheSameNumbers) {
  const NodeMatrix A = StepMatrix(5, true);
  const auto columns = RandomColumns(A.num_nodes, 130, 6);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3 * A.num_nodes, -1.0, 2.0);
  for (const Precision precision : {Precision::kDouble, Precision::kSingle}) {
    SparseCholesky alone;
    alone.Analyze(A);
    ASSERT_TRUE(alone.Factorize(A, precision));
    for (const int size : {1, 2, 4}) {
      Crew crew(size);
      SparseCholesky shared;
      shared.Analyze(A, &crew);
      EXPECT_EQ(shared.num_branches() > 1, size > 1);
      EXPECT_EQ(shared.num_branches_in_solves() > 1, size > 1);
      for (int round = 0; round < 5; ++round) {
        ASSERT_TRUE(shared.Factorize(A, precision));
        EXPECT_EQ(shared.Solve(b), alone.Solve(b));
        EXPECT_EQ(Gram(Eliminated(columns, shared)), Gram(Eliminated(columns, alone)));
      }
      // A copy that works alone on what was cut for several.
      SparseCholesky copy = shared;
      copy.WorkAlone();
      ASSERT_TRUE(copy.Factorize(A, precision));
      EXPECT_EQ(copy.Solve(b), alone.Solve(b));
    }
  }
}

TEST(SparseCholesky, ExchangesFactors) {
  NodeMatrix A = StepMatrix(2, false);
  SparseCholesky first, second;
  first.Analyze(A);
  second.Analyze(A);
  ASSERT_TRUE(first.Factorize(A, Precision::kSingle));
  for (NodeBlock& block : A.values) block *= 2.0;
  ASSERT_TRUE(second.Factorize(A, Precision::kDouble));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(3 * A.num_nodes);
  const Eigen::VectorXd x_first = first.Solve(b), x_second = second.Solve(b);
  first.SwapFactor(&second);
  EXPECT_EQ(first.precision(), Precision::kDouble);
  EXPECT_EQ(first.Solve(b), x_second);
  EXPECT_EQ(second.Solve(b), x_first);
}

TEST(SparseCholesky, BlocksAtTheSamePlaceAddUp) {
  const NodeMatrix A = StepMatrix(2, true);
  NodeMatrix halves = A;
  for (NodeBlock& block : halves.values) block *= 0.5;
  halves.places.insert(halves.places.end(), A.places.begin(), A.places.end());
  halves.values.insert(halves.values.end(), halves.values.begin(),
                       halves.values.begin() + static_cast<std::ptrdiff_t>(A.values.size()));
  SparseCholesky whole, summed;
  whole.Analyze(A);
  summed.Analyze(halves);
  ASSERT_TRUE(whole.Factorize(A));
  ASSERT_TRUE(summed.Factorize(halves));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(3 * A.num_nodes);
  EXPECT_EQ(whole.Solve(b), summed.Solve(b));
}

class Refusal : public testing::TestWithParam<int> {};

TEST_P(Refusal, WhatIsNotPositiveDefinite) {
  NodeMatrix A = StepMatrix(2, false);
  Crew crew(GetParam());
  SparseCholesky cholesky;
  cholesky.Analyze(A, &crew);
  ASSERT_TRUE(cholesky.Factorize(A));
  const auto is_diagonal = [](const auto& place) { return place.row == 2 && place.column == 2; };
  const auto place = std::find_if(A.places.begin(), A.places.end(), is_diagonal);
  double& number = A.values[static_cast<std::size_t>(place - A.places.begin())](1, 1);
  const double before = std::exchange(number, -1.0);
  EXPECT_FALSE(cholesky.Factorize(A));
  number = before;
  EXPECT_TRUE(cholesky.Factorize(A));
}

INSTANTIATE_TEST_SUITE_P(SparseCholesky, Refusal, testing::Values(1, 3));

}  // namespace
}  // namespace vacuum_gripper_sim
