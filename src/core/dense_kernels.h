#pragma once

#include <Eigen/Core>

namespace vacuum_gripper_sim {

/** Dense kernels for the small fronts of SparseCholesky: matrices of some ten to some hundred rows,
 3 n columns, column-major in cache. There, Eigen's kernels for large matrices spend much of their
 time on packing; these read the operands where they are, a tile of the result in registers.

 @tparam Scalar double or float. */

/// Columns of the operands that are read again and again, a multiple of a tile's: so many of some
/// hundred rows stay in the nearest caches.
template <typename Scalar>
constexpr Eigen::Index kKernelDepth = 384 / static_cast<Eigen::Index>(sizeof(Scalar));

/// C = -A A^T, lower triangle. Above the diagonal C is scratch.
/// @param A #rows by depth. @param C #rows square, no padding; #rows a multiple of 3.
template <typename Scalar>
void NegativeSquare(Eigen::Index rows, Eigen::Index depth, const Scalar* A, Eigen::Index stride_A,
                    Scalar* C);

/// C = -A B^T. @param A #rows by depth. @param B #columns by depth. @param C #rows by #columns, no
/// padding; #columns a multiple of 3.
template <typename Scalar>
void NegativeProduct(Eigen::Index rows, Eigen::Index columns, Eigen::Index depth, const Scalar* A,
                     Eigen::Index stride_A, const Scalar* B, Eigen::Index stride_B, Scalar* C);

/// C -= A A^T, lower triangle. Above the diagonal C is scratch, as are the columns that make their
/// number a multiple of 3. @param A #rows by depth; as many rows more as C's columns, zero.
template <typename Scalar>
void SubtractSquare(Eigen::Index rows, Eigen::Index depth, const Scalar* A, Eigen::Index stride_A,
                    Scalar* C, Eigen::Index stride_C);

/// C -= A B^T. @param A #rows by depth. @param B #columns by depth. @param C #rows by #columns;
/// #columns a multiple of 3.
template <typename Scalar>
void SubtractProduct(Eigen::Index rows, Eigen::Index columns, Eigen::Index depth, const Scalar* A,
                     Eigen::Index stride_A, const Scalar* B, Eigen::Index stride_B, Scalar* C,
                     Eigen::Index stride_C);

/// Cholesky factorisation of a panel's first columns: F = (L_11; L_21) from (A_11; A_21).
/// @param[in,out] F #rows by #columns, no padding; #columns a multiple of 3. What is above the
/// diagonal is scratch. @returns false if A_11 is not positive definite.
template <typename Scalar>
bool FactorizePanel(Eigen::Index rows, Eigen::Index columns, Scalar* F);

/// X = X L^-T. @param[in,out] X #rows by #columns; #columns a multiple of 3.
/// @param L Lower triangle, #columns square.
template <typename Scalar>
void SolveOnTheRight(Eigen::Index rows, Eigen::Index columns, const Scalar* L,
                     Eigen::Index stride_L, Scalar* X, Eigen::Index stride_X);

/// x_1 = L_11^-1 x_1, then x_2 -= L_21 x_1, of a panel F = (L_11; L_21).
/// @param F #rows by #columns, no padding; #columns a multiple of 3. @param[in,out] x #rows.
template <typename Scalar>
void EliminateVector(Eigen::Index rows, Eigen::Index columns, const Scalar* F, Scalar* x);

/// x_1 = L_11^-T (x_1 - L_21^T x_2). As EliminateVector().
template <typename Scalar>
void BackSubstituteVector(Eigen::Index rows, Eigen::Index columns, const Scalar* F, Scalar* x);

}  // namespace vacuum_gripper_sim
