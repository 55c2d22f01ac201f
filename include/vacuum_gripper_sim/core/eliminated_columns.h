#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <variant>
#include <vector>

#include "vacuum_gripper_sim/core/matrix_memory.h"

namespace vacuum_gripper_sim {

/// A sparse column: three entries, at the rows of one node.
struct NodeColumn {
  int node{0};
  Eigen::Vector3d value{Eigen::Vector3d::Zero()};
};

/** Y = L^-1 P B for a B of node columns: half of A^-1 B with P A P^T = L L^T, so that
 B^T A^-1 B = Y^T Y. Made by SparseCholesky::EliminateColumns().

 A column is zero outside the path of its node through the elimination tree. Columns are sorted by
 their node's place in that order; those in the subtree below a front then stand side by side, and
 each front stores its rows of just those.

 Products share working memory: one thread at a time. */
class EliminatedColumns {
 public:
  int num_columns() const { return static_cast<int>(order_.size()); }

  /// Y^T y. @param y In elimination order, as of SparseCholesky::Eliminate(). @param[out] product
  /// #columns.
  void TransposeTimes(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> product) const;
  /// y += factor Y x. @param x A value a column.
  void AddTimes(double factor, const Eigen::Ref<const Eigen::VectorXd>& x,
                Eigen::VectorXd* y) const;
  /// Y^T Y, symmetric. @param[out] gram #columns square.
  void Gram(Eigen::Ref<Eigen::MatrixXd> gram) const;
  /// Y^T Z. @param other Z, of the same factorisation. @param[out] product #columns by Z's.
  void TransposeTimes(const EliminatedColumns& other, Eigen::Ref<Eigen::MatrixXd> product) const;

 private:
  friend class SparseCholesky;

  /// Rows `row`, ... of the sorted columns `column`, ...; transposed: #columns by #rows.
  struct Block {
    Eigen::Index row{0}, num_rows{0};
    Eigen::Index column{0}, num_columns{0};
    std::size_t offset{0};
  };
  template <typename Scalar>
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  template <typename Scalar>
  static Eigen::Map<const Matrix<Scalar>> Values(const std::vector<Scalar>& values,
                                                 const Block& block) {
    return {values.data() + block.offset, block.num_columns, block.num_rows};
  }
  template <typename Scalar>
  static Eigen::Map<Matrix<Scalar>> Values(std::vector<Scalar>* values, const Block& block) {
    return {values->data() + block.offset, block.num_columns, block.num_rows};
  }
  template <typename Scalar>
  struct Numbers {
    std::vector<Scalar> values;
    mutable MatrixMemory<Scalar> sorted, rows;  // of products
  };
  Eigen::Index MostRows() const;  // of a block
  Eigen::Map<Eigen::MatrixXd> NegativeProduct(Eigen::Index rows, Eigen::Index columns) const;
  void PutInGivenOrder(const Eigen::Ref<const Eigen::MatrixXd>& negative,
                       const EliminatedColumns& other, Eigen::Ref<Eigen::MatrixXd> product) const;

  std::vector<int> order_;                                   // the sorted columns' numbers in B
  std::vector<Block> blocks_;                                // rows ascending
  std::variant<Numbers<double>, Numbers<float>> numbers_;    // as the factor's
  mutable MatrixMemory<double> sorted_, wide_, their_wide_;  // of products in double precision
};

}  // namespace vacuum_gripper_sim
