#include "vacuum_gripper_sim/core/eliminated_columns.h"

#include <algorithm>
#include <type_traits>

#include "dense_kernels.h"

namespace vacuum_gripper_sim {

using Eigen::Index;

namespace {

template <typename Numbers>
using ScalarOf = typename std::decay_t<decltype(Numbers::values)>::value_type;

Index MultipleOf3(Index size) { return (size + 2) / 3 * 3; }

/// Some of a block's rows in double precision, and zeros beside them for columns that make their
/// number a multiple of 3, as dense kernels want it.
template <typename Part>
Eigen::Map<Eigen::MatrixXd> Widened(const Part& part, MatrixMemory<double>* memory) {
  Eigen::Map<Eigen::MatrixXd> wide = memory->Shape(MultipleOf3(part.rows()), part.cols());
  wide.topRows(part.rows()) = part.template cast<double>();
  wide.bottomRows(wide.rows() - part.rows()).setZero();
  return wide;
}

/// Calls f(first, count) on as many of a block's rows as are multiplied at a time.
template <typename Function>
void ForParts(Index num_rows, const Function& f) {
  constexpr Index kDepth = kKernelDepth<double>;
  for (Index first = 0; first < num_rows; first += kDepth) {
    f(first, std::min(num_rows - first, kDepth));
  }
}

}  // namespace

Index EliminatedColumns::MostRows() const {
  Index most = 0;
  for (const Block& block : blocks_) most = std::max(most, block.num_rows);
  return most;
}

void EliminatedColumns::TransposeTimes(const Eigen::VectorXd& y,
                                       Eigen::Ref<Eigen::VectorXd> product) const {
  std::visit(
      [&](const auto& numbers) {
        using Scalar = ScalarOf<std::decay_t<decltype(numbers)>>;
        auto sorted = numbers.sorted.Shape(num_columns());
        auto work = numbers.rows.Shape(MostRows());
        sorted.setZero();
        for (const Block& block : blocks_) {
          auto rows = work.head(block.num_rows);
          rows = y.segment(block.row, block.num_rows).template cast<Scalar>();
          sorted.segment(block.column, block.num_columns).noalias() +=
              Values(numbers.values, block) * rows;
        }
        for (Index k = 0; k < product.size(); ++k) {
          product(order_[static_cast<std::size_t>(k)]) = sorted(k);
        }
      },
      numbers_);
}

void EliminatedColumns::AddTimes(double factor, const Eigen::Ref<const Eigen::VectorXd>& x,
                                 Eigen::VectorXd* y) const {
  std::visit(
      [&](const auto& numbers) {
        using Scalar = ScalarOf<std::decay_t<decltype(numbers)>>;
        auto sorted = numbers.sorted.Shape(num_columns());
        for (Index k = 0; k < sorted.size(); ++k) {
          sorted(k) = static_cast<Scalar>(factor * x(order_[static_cast<std::size_t>(k)]));
        }
        auto work = numbers.rows.Shape(MostRows());
        for (const Block& block : blocks_) {
          auto rows = work.head(block.num_rows);
          rows.noalias() = Values(numbers.values, block).transpose() *
                           sorted.segment(block.column, block.num_columns);
          y->segment(block.row, block.num_rows) += rows.template cast<double>();
        }
      },
      numbers_);
}

/// In double precision whatever Y's: contacts at one node differ by less than single rounding.
// NOLINTNEXTLINE(performance-unnecessary-value-param): a view that is written through
void EliminatedColumns::Gram(Eigen::Ref<Eigen::MatrixXd> gram) const {
  Eigen::Map<Eigen::MatrixXd> negative = NegativeProduct(num_columns(), num_columns());
  std::visit(
      [&](const auto& numbers) {
        for (const Block& block : blocks_) {
          const auto values = Values(numbers.values, block);
          ForParts(block.num_rows, [&](Index first, Index count) {
            const auto part = Widened(values.middleCols(first, count), &wide_);
            SubtractSquare(block.num_columns, count, part.data(), part.rows(),
                           &negative(block.column, block.column), negative.rows());
          });
        }
      },
      numbers_);
  negative.triangularView<Eigen::StrictlyUpper>() = negative.transpose();
  PutInGivenOrder(negative, *this, gram);
}

/// In the other's working memory, so that products of many with one take memory once.
void EliminatedColumns::TransposeTimes(const EliminatedColumns& other,
                                       // NOLINTNEXTLINE(performance-unnecessary-value-param)
                                       Eigen::Ref<Eigen::MatrixXd> product) const {
  Eigen::Map<Eigen::MatrixXd> negative = other.NegativeProduct(num_columns(), other.num_columns());
  std::visit(
      [&](const auto& numbers) {
        const auto& their_numbers = std::get<std::decay_t<decltype(numbers)>>(other.numbers_);
        auto theirs = other.blocks_.begin();
        for (const Block& ours : blocks_) {
          while (theirs != other.blocks_.end() && theirs->row < ours.row) ++theirs;
          if (theirs == other.blocks_.end()) break;
          if (theirs->row != ours.row) continue;
          const auto values = Values(numbers.values, ours);
          const auto their_values = Values(their_numbers.values, *theirs);
          ForParts(ours.num_rows, [&](Index first, Index count) {
            const auto part = Widened(values.middleCols(first, count), &other.wide_);
            const auto their_part =
                Widened(their_values.middleCols(first, count), &other.their_wide_);
            SubtractProduct(ours.num_columns, their_part.rows(), count, part.data(), part.rows(),
                            their_part.data(), their_part.rows(),
                            &negative(ours.column, theirs->column), negative.rows());
          });
        }
      },
      numbers_);
  PutInGivenOrder(negative, other, product);
}

/// Zeros, by sorted columns; more columns in memory, as dense kernels write three at a time.
Eigen::Map<Eigen::MatrixXd> EliminatedColumns::NegativeProduct(Index rows, Index columns) const {
  Eigen::Map<Eigen::MatrixXd> negative = sorted_.Shape(rows, columns + 2);
  negative.setZero();
  return {negative.data(), rows, columns};
}

void EliminatedColumns::PutInGivenOrder(const Eigen::Ref<const Eigen::MatrixXd>& negative,
                                        const EliminatedColumns& other,
                                        Eigen::Ref<Eigen::MatrixXd> product) const {
  for (Index j = 0; j < negative.cols(); ++j) {
    const int column = other.order_[static_cast<std::size_t>(j)];
    for (Index i = 0; i < negative.rows(); ++i) {
      product(order_[static_cast<std::size_t>(i)], column) = -negative(i, j);
    }
  }
}

}  // namespace vacuum_gripper_sim
