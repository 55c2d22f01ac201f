#include "dense_kernels.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;

/// Rows of a tile: two vector registers, so that with six columns twelve sums are in flight.
template <typename Scalar>
constexpr int kTileRows = 2 * std::max(16, EIGEN_MAX_STATIC_ALIGN_BYTES) /
                          static_cast<int>(sizeof(Scalar));
constexpr int kTileColumns = 6;

enum class Write { kAssign, kSubtract };

template <typename Scalar, int kRows>
using Column = Eigen::Matrix<Scalar, kRows, 1>;

/// Calls f(row, integral constant #rows) on tiles of [begin, end): full ones, then halves.
template <int kRows, typename Function>
void ForRowTiles(Index begin, Index end, const Function& f) {
  for (; begin + kRows <= end; begin += kRows) f(begin, std::integral_constant<int, kRows>());
  if constexpr (kRows > 1) {
    if (begin < end) ForRowTiles<kRows / 2>(begin, end, f);
  }
}

/// The same for columns, whose number is a multiple of 3.
template <typename Function>
void ForColumnTiles(Index end, const Function& f) {
  Index begin = 0;
  for (; begin + kTileColumns <= end; begin += kTileColumns) {
    f(begin, std::integral_constant<int, kTileColumns>());
  }
  if (begin < end) f(begin, std::integral_constant<int, kTileColumns / 2>());
}

/// The same, from the last to the first.
template <typename Function>
void ForColumnTilesBackwards(Index end, const Function& f) {
  if (end % kTileColumns != 0) {
    end -= kTileColumns / 2;
    f(end, std::integral_constant<int, kTileColumns / 2>());
  }
  for (end -= kTileColumns; end >= 0; end -= kTileColumns) {
    f(end, std::integral_constant<int, kTileColumns>());
  }
}

/// C = -A B^T or C -= A B^T of one tile.
template <int kRows, int kColumns, Write kWrite, typename Scalar>
void Tile(Index depth, const Scalar* a, Index stride_a, const Scalar* b, Index stride_b, Scalar* c,
          Index stride_c) {
  Column<Scalar, kRows> sums[kColumns];
  for (int j = 0; j < kColumns; ++j) sums[j].setZero();
  for (Index k = 0; k < depth; ++k) {
    const Column<Scalar, kRows> x = Eigen::Map<const Column<Scalar, kRows>>(a + k * stride_a);
    for (int j = 0; j < kColumns; ++j) sums[j] += b[j + k * stride_b] * x;
  }
  for (int j = 0; j < kColumns; ++j) {
    Eigen::Map<Column<Scalar, kRows>> target(c + j * stride_c);
    if constexpr (kWrite == Write::kAssign) {
      target = -sums[j];
    } else {
      target -= sums[j];
    }
  }
}

/// 1 / L_jj of a diagonal tile: all at once, for in a solve each division would wait for the last.
template <int kColumns, typename Scalar>
Column<Scalar, kColumns> InverseDiagonal(const Scalar* L, Index stride) {
  Column<Scalar, kColumns> inverse;
  for (int j = 0; j < kColumns; ++j) inverse[j] = Scalar(1) / L[j * (stride + 1)];
  return inverse;
}

/// X = X L^-T of one tile. @param inverse_diagonal Of L.
template <int kRows, int kColumns, typename Scalar>
void SolveTile(const Scalar* L, Index stride_L, const Column<Scalar, kColumns>& inverse_diagonal,
               Scalar* X, Index stride_X) {
  Column<Scalar, kRows> x[kColumns];
  for (int j = 0; j < kColumns; ++j) {
    x[j] = Eigen::Map<const Column<Scalar, kRows>>(X + j * stride_X);
    for (int k = 0; k < j; ++k) x[j] -= L[j + k * stride_L] * x[k];
    x[j] *= inverse_diagonal[j];
    Eigen::Map<Column<Scalar, kRows>>(X + j * stride_X) = x[j];
  }
}

/// x = L^-T x of one tile.
template <int kColumns, typename Scalar>
void SolveTileTransposed(const Scalar* L, Index stride_L, Scalar* x) {
  const Column<Scalar, kColumns> inverse_diagonal = InverseDiagonal<kColumns>(L, stride_L);
  Scalar solved[kColumns];
  for (int i = 0; i < kColumns; ++i) {
    const int j = kColumns - 1 - i;
    solved[j] = x[j];
    // What was solved last comes last, so that the others need not wait for it.
    for (int k = kColumns - 1; k > j; --k) solved[j] -= L[k + j * stride_L] * solved[k];
    solved[j] *= inverse_diagonal[j];
    x[j] = solved[j];
  }
}

/// Cholesky factorisation of a diagonal tile.
template <int kColumns, typename Scalar>
bool FactorizeTile(Scalar* L, Index stride, Column<Scalar, kColumns>* inverse_diagonal) {
  for (int j = 0; j < kColumns; ++j) {
    Scalar* const column = L + j * stride;
    for (int k = 0; k < j; ++k) {
      for (int i = j; i < kColumns; ++i) column[i] -= L[i + k * stride] * L[j + k * stride];
    }
    if (!(column[j] > Scalar(0))) return false;
    column[j] = std::sqrt(column[j]);
    (*inverse_diagonal)[j] = Scalar(1) / column[j];
    for (int i = j + 1; i < kColumns; ++i) column[i] *= (*inverse_diagonal)[j];
  }
  return true;
}

/// C = -A B^T or C -= A B^T. @param lower Only tiles that touch the lower triangle.
template <Write kWrite, typename Scalar>
void Product(bool lower, Index rows, Index columns, Index depth, const Scalar* A, Index stride_A,
             const Scalar* B, Index stride_B, Scalar* C, Index stride_C) {
  ForColumnTiles(columns, [&](Index column, auto num_columns) {
    constexpr int kColumns = num_columns;
    ForRowTiles<kTileRows<Scalar>>(lower ? column : 0, rows, [&](Index row, auto num_rows) {
      Tile<num_rows, kColumns, kWrite>(depth, A + row, stride_A, B + column, stride_B,
                                       C + row + column * stride_C, stride_C);
    });
  });
}

/// C = -A B^T, a few columns of A and B at a time, so that they stay in the nearest cache.
template <typename Scalar>
void NegativeProduct(bool lower, Index rows, Index columns, Index depth, const Scalar* A,
                     Index stride_A, const Scalar* B, Index stride_B, Scalar* C) {
  Product<Write::kAssign>(lower, rows, columns, std::min(depth, kKernelDepth<Scalar>), A, stride_A,
                          B, stride_B, C, rows);
  for (Index k = kKernelDepth<Scalar>; k < depth; k += kKernelDepth<Scalar>) {
    Product<Write::kSubtract>(lower, rows, columns, std::min(depth - k, kKernelDepth<Scalar>),
                              A + k * stride_A, stride_A, B + k * stride_B, stride_B, C, rows);
  }
}

/// FactorizePanel() of a few columns.
template <typename Scalar>
bool FactorizeNarrowPanel(Index rows, Index columns, Scalar* F, Index stride) {
  bool positive = true;
  ForColumnTiles(columns, [&](Index column, auto num_columns) {
    constexpr int kColumns = num_columns;
    Scalar* const target = F + column * stride;
    ForRowTiles<kTileRows<Scalar>>(column, rows, [&](Index row, auto num_rows) {
      Tile<num_rows, kColumns, Write::kSubtract>(column, F + row, stride, F + column, stride,
                                                 target + row, stride);
    });
    Column<Scalar, kColumns> inverse_diagonal;
    positive = positive && FactorizeTile(target + column, stride, &inverse_diagonal);
    if (!positive) return;
    ForRowTiles<kTileRows<Scalar>>(column + kColumns, rows, [&](Index row, auto num_rows) {
      SolveTile<num_rows, kColumns>(target + column, stride, inverse_diagonal, target + row,
                                    stride);
    });
  });
  return positive;
}

/// SolveOnTheRight() of a few columns.
template <typename Scalar>
void SolveNarrow(Index rows, Index columns, const Scalar* L, Index stride_L, Scalar* X,
                 Index stride_X) {
  ForColumnTiles(columns, [&](Index column, auto num_columns) {
    constexpr int kColumns = num_columns;
    const Scalar* const L_own = L + column * (stride_L + 1);
    const Column<Scalar, kColumns> inverse_diagonal = InverseDiagonal<kColumns>(L_own, stride_L);
    ForRowTiles<kTileRows<Scalar>>(0, rows, [&](Index row, auto num_rows) {
      Scalar* const target = X + row + column * stride_X;
      Tile<num_rows, kColumns, Write::kSubtract>(column, X + row, stride_X, L + column, stride_L,
                                                 target, stride_X);
      SolveTile<num_rows, kColumns>(L_own, stride_L, inverse_diagonal, target, stride_X);
    });
  });
}

/// How far a sweep asks ahead for what it will read: once, of a factor that the near caches cannot
/// hold, by columns too short for the processor to foresee the next one.
constexpr Index kTilesAhead = 2;

/// Of a column, which may lie outside of all memory there is.
template <int kRows, typename Scalar>
void Prefetch(const Scalar* column) {
  constexpr int kCacheLine = 64 / sizeof(Scalar);
  for (int row = 0; row < kRows; row += kCacheLine) __builtin_prefetch(column + row);
}

/// x_2 -= L_21 x_1 of the columns of one tile. @param rows Of L_21.
template <int kColumns, typename Scalar>
void SubtractColumns(Index rows, const Scalar* L_21, Index stride, const Scalar* x_1, Scalar* x_2) {
  ForRowTiles<kTileRows<Scalar>>(0, rows, [&](Index row, auto num_rows) {
    Eigen::Map<Column<Scalar, num_rows>> target(x_2 + row);
    Column<Scalar, num_rows> sum = target;
    for (int j = 0; j < kColumns; ++j) {
      const Scalar* const L = L_21 + row + j * stride;
      sum -= x_1[j] * Eigen::Map<const Column<Scalar, num_rows>>(L);
      Prefetch<num_rows>(L + kTilesAhead * kColumns * stride);
    }
    target = sum;
  });
}

/// Ones in the last lanes of a vector register.
template <int kRows, typename Scalar>
Column<Scalar, kRows> LastLanes(Index count) {
  Column<Scalar, kRows> lanes;
  for (int i = 0; i < kRows; ++i) lanes[i] = i < kRows - count ? Scalar(0) : Scalar(1);
  return lanes;
}

/// x_1 -= L_21^T x_2 of the columns of one tile. @param rows Of L_21.
template <int kColumns, typename Scalar>
void SubtractProducts(Index rows, const Scalar* L_21, Index stride, const Scalar* x_2,
                      Scalar* x_1) {
  constexpr int kRows = kTileRows<Scalar> / 2;
  if (rows < kRows) {
    for (int j = 0; j < kColumns; ++j) {
      for (Index row = 0; row < rows; ++row) x_1[j] -= L_21[row + j * stride] * x_2[row];
    }
    return;
  }
  Column<Scalar, kRows> sums[kColumns];
  for (int j = 0; j < kColumns; ++j) sums[j].setZero();
  const auto add = [&](Index row, const Column<Scalar, kRows>& x) {
    for (int j = 0; j < kColumns; ++j) {
      const Scalar* const L = L_21 + row + j * stride;
      sums[j] += Eigen::Map<const Column<Scalar, kRows>>(L).cwiseProduct(x);
      Prefetch<kRows>(L - kTilesAhead * kColumns * stride);
    }
  };
  const auto x_at = [&](Index row) { return Eigen::Map<const Column<Scalar, kRows>>(x_2 + row); };
  Index row = 0;
  for (; row + kRows <= rows; row += kRows) add(row, x_at(row));
  if (row < rows) {  // the last rows, in the last lanes of a whole register
    const Index last = rows - kRows;
    add(last, x_at(last).cwiseProduct(LastLanes<kRows, Scalar>(rows - row)));
  }
  for (int j = 0; j < kColumns; ++j) x_1[j] -= sums[j].sum();
}

}  // namespace

template <typename Scalar>
void NegativeSquare(Index rows, Index depth, const Scalar* A, Index stride_A, Scalar* C) {
  NegativeProduct(true, rows, rows, depth, A, stride_A, A, stride_A, C);
}

template <typename Scalar>
void NegativeProduct(Index rows, Index columns, Index depth, const Scalar* A, Index stride_A,
                     const Scalar* B, Index stride_B, Scalar* C) {
  NegativeProduct(false, rows, columns, depth, A, stride_A, B, stride_B, C);
}

template <typename Scalar>
void SubtractSquare(Index rows, Index depth, const Scalar* A, Index stride_A, Scalar* C,
                    Index stride_C) {
  Product<Write::kSubtract>(true, rows, (rows + 2) / 3 * 3, depth, A, stride_A, A, stride_A, C,
                            stride_C);
}

template <typename Scalar>
void SubtractProduct(Index rows, Index columns, Index depth, const Scalar* A, Index stride_A,
                     const Scalar* B, Index stride_B, Scalar* C, Index stride_C) {
  Product<Write::kSubtract>(false, rows, columns, depth, A, stride_A, B, stride_B, C, stride_C);
}

template <typename Scalar>
bool FactorizePanel(Index rows, Index columns, Scalar* F) {
  for (Index k = 0; k < columns; k += kKernelDepth<Scalar>) {
    const Index width = std::min(columns - k, kKernelDepth<Scalar>);
    if (!FactorizeNarrowPanel(rows - k, width, F + k * (rows + 1), rows)) return false;
    const Index next = k + width;
    const Scalar* const done = F + next + k * rows;
    Product<Write::kSubtract>(true, rows - next, columns - next, width, done, rows, done, rows,
                              F + next * (rows + 1), rows);
  }
  return true;
}

template <typename Scalar>
void SolveOnTheRight(Index rows, Index columns, const Scalar* L, Index stride_L, Scalar* X,
                     Index stride_X) {
  for (Index k = 0; k < columns; k += kKernelDepth<Scalar>) {
    const Index width = std::min(columns - k, kKernelDepth<Scalar>);
    SolveNarrow(rows, width, L + k * (stride_L + 1), stride_L, X + k * stride_X, stride_X);
    const Index next = k + width;
    Product<Write::kSubtract>(false, rows, columns - next, width, X + k * stride_X, stride_X,
                              L + next + k * stride_L, stride_L, X + next * stride_X, stride_X);
  }
}

template <typename Scalar>
void EliminateVector(Index rows, Index columns, const Scalar* F, Scalar* x) {
  ForColumnTiles(columns, [&](Index column, auto num_columns) {
    constexpr int kColumns = num_columns;
    const Scalar* const L = F + column * (rows + 1);
    Scalar* const own = x + column;
    SolveTile<1, kColumns>(L, rows, InverseDiagonal<kColumns>(L, rows), own, Index{1});
    SubtractColumns<kColumns>(rows - column - kColumns, L + kColumns, rows, own, own + kColumns);
  });
}

template <typename Scalar>
void BackSubstituteVector(Index rows, Index columns, const Scalar* F, Scalar* x) {
  ForColumnTilesBackwards(columns, [&](Index column, auto num_columns) {
    constexpr int kColumns = num_columns;
    const Scalar* const L = F + column * (rows + 1);
    Scalar* const own = x + column;
    SubtractProducts<kColumns>(rows - column - kColumns, L + kColumns, rows, own + kColumns, own);
    SolveTileTransposed<kColumns>(L, rows, own);
  });
}

template void NegativeSquare(Index, Index, const double*, Index, double*);
template void NegativeProduct(Index, Index, Index, const double*, Index, const double*, Index,
                              double*);
template void SubtractSquare(Index, Index, const double*, Index, double*, Index);
template void SubtractProduct(Index, Index, Index, const double*, Index, const double*, Index,
                              double*, Index);
template bool FactorizePanel(Index, Index, double*);
template void SolveOnTheRight(Index, Index, const double*, Index, double*, Index);
template void EliminateVector(Index, Index, const double*, double*);
template void BackSubstituteVector(Index, Index, const double*, double*);
template void NegativeSquare(Index, Index, const float*, Index, float*);
template void NegativeProduct(Index, Index, Index, const float*, Index, const float*, Index,
                              float*);
template void SubtractSquare(Index, Index, const float*, Index, float*, Index);
template void SubtractProduct(Index, Index, Index, const float*, Index, const float*, Index, float*,
                              Index);
template bool FactorizePanel(Index, Index, float*);
template void SolveOnTheRight(Index, Index, const float*, Index, float*, Index);
template void EliminateVector(Index, Index, const float*, float*);
template void BackSubstituteVector(Index, Index, const float*, float*);

}  // namespace vacuum_gripper_sim
