#include "dense_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Sizes that leave every remainder of tiles, and more columns than are worked on at a time.
const Index kRows[] = {3, 6, 9, 15, 24, 51, 105, 171};
const Index kColumns[] = {3, 6, 15, 48, 51, 105};

MatrixXd PositiveDefinite(Index size) {
  const MatrixXd root = MatrixXd::Random(size, size);
  return root * root.transpose() + static_cast<double>(size) * MatrixXd::Identity(size, size);
}

TEST(DenseKernels, ProductsAreThoseOfMatrices) {
  for (const Index rows : kRows) {
    for (const Index depth : kColumns) {
      const MatrixXd A = MatrixXd::Random(rows + 2, depth);  // a part of a larger panel
      MatrixXd square(rows, rows);
      NegativeSquare(rows, depth, A.data() + 1, A.rows(), square.data());
      const MatrixXd part = A.middleRows(1, rows);
      const MatrixXd expected = -part * part.transpose();
      const MatrixXd error = (square - expected).triangularView<Eigen::Lower>();
      EXPECT_LT(error.norm(), 1e-13 * expected.norm()) << rows << " " << depth;

      const MatrixXd B = MatrixXd::Random(15, depth);
      MatrixXd product(rows, 15);
      NegativeProduct(rows, 15, depth, A.data() + 1, A.rows(), B.data(), 15, product.data());
      EXPECT_LT((product + part * B.transpose()).norm(), 1e-12 * product.norm());
    }
  }
}

TEST(DenseKernels, APanelIsFactorisedAsTheWholeMatrix) {
  for (const Index rows : kRows) {
    const MatrixXd A = PositiveDefinite(rows);
    const MatrixXd L = A.llt().matrixL();
    for (const Index columns : kColumns) {
      if (columns > rows) continue;
      MatrixXd F = A.leftCols(columns);
      ASSERT_TRUE(FactorizePanel(rows, columns, F.data()));
      const MatrixXd error = MatrixXd(F - L.leftCols(columns)).triangularView<Eigen::Lower>();
      EXPECT_LT(error.norm(), 1e-13 * L.norm()) << rows << " " << columns;
    }
  }
}

TEST(DenseKernels, APanelThatIsNotPositiveDefiniteIsRefused) {
  for (const Index bad : {0, 5, 50, 104}) {
    MatrixXd A = PositiveDefinite(105);
    A(bad, bad) = -1.0;
    EXPECT_FALSE(FactorizePanel(105, 105, A.data())) << bad;
  }
}

TEST(DenseKernels, SolvesOnTheRight) {
  for (const Index columns : kColumns) {
    const MatrixXd L = PositiveDefinite(columns).llt().matrixL();
    for (const Index rows : {1, 2, 7, 8, 100}) {
      const MatrixXd X = MatrixXd::Random(rows, columns);
      MatrixXd solved = X;
      SolveOnTheRight(rows, columns, L.data(), columns, solved.data());
      EXPECT_LT((solved * L.transpose() - X).norm(), 1e-12 * X.norm()) << rows << " " << columns;
    }
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
