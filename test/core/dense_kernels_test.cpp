#include "dense_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;

template <typename Scalar>
class DenseKernels : public testing::Test {
 protected:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  /// Some hundred roundings.
  static constexpr double kError = 500.0 * std::numeric_limits<Scalar>::epsilon();

  static Matrix PositiveDefinite(Index size) {
    const Matrix root = Matrix::Random(size, size);
    return root * root.transpose() + static_cast<Scalar>(size) * Matrix::Identity(size, size);
  }
};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(DenseKernels, Scalars);

// Sizes that leave every remainder of tiles, and more columns than are worked on at a time.
const Index kRows[] = {3, 6, 9, 15, 24, 51, 105, 171};
const Index kColumns[] = {3, 6, 15, 48, 51, 105};

TYPED_TEST(DenseKernels, ProductsAreThoseOfMatrices) {
  using Matrix = typename TestFixture::Matrix;
  for (const Index rows : kRows) {
    for (const Index depth : kColumns) {
      const Matrix A = Matrix::Random(rows + 2, depth);  // a part of a larger panel
      Matrix square(rows, rows);
      NegativeSquare(rows, depth, A.data() + 1, A.rows(), square.data());
      const Matrix part = A.middleRows(1, rows);
      const Matrix expected = -part * part.transpose();
      const Matrix error = (square - expected).template triangularView<Eigen::Lower>();
      EXPECT_LT(error.norm(), TestFixture::kError * expected.norm()) << rows << " " << depth;

      const Matrix B = Matrix::Random(15, depth);
      Matrix product(rows, 15);
      NegativeProduct(rows, 15, depth, A.data() + 1, A.rows(), B.data(), 15, product.data());
      EXPECT_LT((product + part * B.transpose()).norm(), TestFixture::kError * product.norm());
    }
  }
}

TYPED_TEST(DenseKernels, ProductsOfAnyNumberOfRowsAreSubtracted) {
  using Matrix = typename TestFixture::Matrix;
  for (const Index rows : {1, 2, 3, 5, 8, 13, 22, 52, 101}) {
    for (const Index depth : {1, 3, 48}) {
      const Index columns = (rows + 2) / 3 * 3;
      Matrix A = Matrix::Random(columns, depth);
      A.bottomRows(columns - rows).setZero();
      const Matrix part = A.topRows(rows);
      const Matrix before = Matrix::Random(rows + 2, columns);  // a part of a larger matrix

      Matrix C = before;
      SubtractSquare(rows, depth, A.data(), columns, C.data() + 1, C.rows());
      Matrix expected = before;
      expected.block(1, 0, rows, rows) -= part * part.transpose();
      const double bound = TestFixture::kError * (1.0 + expected.norm());
      const Matrix error =
          (C - expected).block(1, 0, rows, rows).template triangularView<Eigen::Lower>();
      EXPECT_LT(error.norm(), bound) << rows << " " << depth;

      const Matrix B = Matrix::Random(15, depth);
      C.setOnes(rows + 2, 15);
      SubtractProduct(rows, 15, depth, A.data(), columns, B.data(), 15, C.data() + 1, C.rows());
      expected.setOnes(rows + 2, 15);
      expected.middleRows(1, rows) -= part * B.transpose();
      EXPECT_LT((C - expected).norm(), bound) << rows << " " << depth;
      EXPECT_EQ(C.topRows(1), expected.topRows(1));
      EXPECT_EQ(C.bottomRows(1), expected.bottomRows(1));
    }
  }
}

TYPED_TEST(DenseKernels, APanelIsFactorisedAsTheWholeMatrix) {
  using Matrix = typename TestFixture::Matrix;
  for (const Index rows : kRows) {
    const Matrix A = TestFixture::PositiveDefinite(rows);
    const Matrix L = A.llt().matrixL();
    for (const Index columns : kColumns) {
      if (columns > rows) continue;
      Matrix F = A.leftCols(columns);
      ASSERT_TRUE(FactorizePanel(rows, columns, F.data()));
      const Matrix error = Matrix(F - L.leftCols(columns)).template triangularView<Eigen::Lower>();
      EXPECT_LT(error.norm(), TestFixture::kError * L.norm()) << rows << " " << columns;
    }
  }
}

TYPED_TEST(DenseKernels, APanelThatIsNotPositiveDefiniteIsRefused) {
  using Matrix = typename TestFixture::Matrix;
  for (const Index bad : {0, 5, 50, 104}) {
    Matrix A = TestFixture::PositiveDefinite(105);
    A(bad, bad) = -1;
    EXPECT_FALSE(FactorizePanel(105, 105, A.data())) << bad;
  }
}

TYPED_TEST(DenseKernels, SolvesOnTheRight) {
  using Matrix = typename TestFixture::Matrix;
  for (const Index columns : kColumns) {
    const Matrix L = TestFixture::PositiveDefinite(columns).llt().matrixL();
    for (const Index rows : {1, 2, 7, 8, 100}) {
      // Between rows that belong to others.
      const Index padding = 3;
      const Matrix X = Matrix::Random(padding + rows + padding, columns);
      Matrix solved = X;
      SolveOnTheRight(rows, columns, L.data(), columns, solved.data() + padding, X.rows());
      const Matrix X_own = X.middleRows(padding, rows);
      EXPECT_LT((solved.middleRows(padding, rows) * L.transpose() - X_own).norm(),
                TestFixture::kError * X_own.norm())
          << rows << " " << columns;
      EXPECT_EQ(solved.topRows(padding), X.topRows(padding));
      EXPECT_EQ(solved.bottomRows(padding), X.bottomRows(padding));
    }
  }
}

TYPED_TEST(DenseKernels, VectorsAreEliminatedAndSubstitutedAsByTheWholeMatrix) {
  using Matrix = typename TestFixture::Matrix;
  using Vector = Eigen::Matrix<TypeParam, Eigen::Dynamic, 1>;
  for (const Index rows : kRows) {
    const Matrix L = TestFixture::PositiveDefinite(rows).llt().matrixL();
    for (const Index columns : kColumns) {
      if (columns > rows) continue;
      const Matrix F = L.leftCols(columns);
      const auto L_11 = F.topRows(columns).template triangularView<Eigen::Lower>();
      const auto L_21 = F.bottomRows(rows - columns);
      const Vector x = Vector::Random(rows);

      Vector eliminated = x;
      EliminateVector(rows, columns, F.data(), eliminated.data());
      Vector expected = x;
      auto head = expected.head(columns);
      L_11.solveInPlace(head);
      expected.tail(rows - columns) -= L_21 * expected.head(columns);
      EXPECT_LT((eliminated - expected).norm(), TestFixture::kError * x.norm())
          << rows << " " << columns;

      Vector substituted = x;
      BackSubstituteVector(rows, columns, F.data(), substituted.data());
      expected = x;
      expected.head(columns) -= L_21.transpose() * x.tail(rows - columns);
      L_11.transpose().solveInPlace(head);
      EXPECT_LT((substituted - expected).norm(), TestFixture::kError * x.norm())
          << rows << " " << columns;
    }
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
