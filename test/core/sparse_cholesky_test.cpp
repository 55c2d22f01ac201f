#include "vacuum_gripper_sim/core/sparse_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "support/block_mesh.h"
#include "vacuum_gripper_sim/core/elastic_body.h"

namespace vacuum_gripper_sim {
namespace {

/// K + mass of a block, lower triangle: what stepping factorises.
Eigen::SparseMatrix<double> StepMatrix(int cells, bool quadratic) {
  const TetMesh mesh = MakeBlock(cells, cells + 1, cells, {0.02, 0.03, 0.01}, quadratic);
  const ElasticBody body(mesh, {338000.0, 0.45, 1080.0});
  Eigen::SparseMatrix<double> A = body.Stiffness(mesh.nodes);
  for (int i = 0; i < A.cols(); ++i) A.coeffRef(i, i) += 10.0 + 0.1 * i;
  Eigen::SparseMatrix<double> lower = A.triangularView<Eigen::Lower>();
  lower.makeCompressed();
  return lower;
}

Eigen::MatrixXd Dense(const Eigen::SparseMatrix<double>& lower) {
  return Eigen::MatrixXd(Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>());
}

TEST(SparseCholesky, SolvesLikeADenseFactorisation) {
  for (const bool quadratic : {false, true}) {
    for (const int cells : {1, 2, 4}) {
      const Eigen::SparseMatrix<double> A = StepMatrix(cells, quadratic);
      SparseCholesky cholesky;
      cholesky.Analyze(A);
      ASSERT_TRUE(cholesky.Factorize(A));
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(A.cols(), -1.0, 2.0);
      const Eigen::VectorXd expected = Dense(A).llt().solve(b);
      EXPECT_LT((cholesky.Solve(b) - expected).norm(), 1e-11 * expected.norm());

      // New values in the old structure.
      Eigen::SparseMatrix<double> doubled = 2.0 * A;
      ASSERT_TRUE(cholesky.Factorize(doubled));
      EXPECT_LT((cholesky.Solve(b) - 0.5 * expected).norm(), 1e-11 * expected.norm());
    }
  }
}

// Separate bodies are separate trees.
TEST(SparseCholesky, HandlesAForest) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < 12; ++i) entries.emplace_back(i, i, 2.0 + i);
  entries.emplace_back(4, 1, 0.5);
  Eigen::SparseMatrix<double> A(12, 12);
  A.setFromTriplets(entries.begin(), entries.end());
  SparseCholesky cholesky;
  cholesky.Analyze(A);
  ASSERT_TRUE(cholesky.Factorize(A));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(12);
  EXPECT_LT((Dense(A) * cholesky.Solve(b) - b).norm(), 1e-14);
}

TEST(SparseCholesky, InverseFormIsThatOfTheDenseInverse) {
  const Eigen::SparseMatrix<double> A = StepMatrix(3, true);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int num_nodes = static_cast<int>(A.cols()) / 3;
  std::vector<Eigen::Triplet<double>> entries;
  const int num_columns = 40;
  for (int c = 0; c < num_columns; ++c) {
    const int node = (c * 37) % num_nodes;  // some nodes twice
    for (int i = 0; i < 3; ++i) entries.emplace_back(3 * node + i, c, uniform(random));
  }
  Eigen::SparseMatrix<double> B(A.cols(), num_columns);
  B.setFromTriplets(entries.begin(), entries.end());
  SparseCholesky cholesky;
  cholesky.Analyze(A);
  ASSERT_TRUE(cholesky.Factorize(A));
  const Eigen::MatrixXd B_dense(B);
  const Eigen::MatrixXd expected = B_dense.transpose() * Dense(A).llt().solve(B_dense);
  const Eigen::MatrixXd form = cholesky.InverseForm(B);
  EXPECT_LT((form - expected).norm(), 1e-12 * expected.norm());
  EXPECT_EQ(form, form.transpose());
}

TEST(SparseCholesky, RefusesWhatIsNotPositiveDefinite) {
  Eigen::SparseMatrix<double> A = StepMatrix(2, false);
  SparseCholesky cholesky;
  cholesky.Analyze(A);
  A.coeffRef(7, 7) = -1.0;
  EXPECT_FALSE(cholesky.Factorize(A));
  const Eigen::SparseMatrix<double> odd(4, 4);
  EXPECT_THROW(cholesky.Analyze(odd), std::invalid_argument);
}

}  // namespace
}  // namespace vacuum_gripper_sim
