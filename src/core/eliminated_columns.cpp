#include "vacuum_gripper_sim/core/eliminated_columns.h"

#include <algorithm>
#include <type_traits>

namespace vacuum_gripper_sim {

using Eigen::Index;

namespace {

template <typename Numbers>
using ScalarOf = typename std::decay_t<decltype(Numbers::values)>::value_type;

/// A part of a block in double precision.
template <typename Part>
Eigen::Map<Eigen::MatrixXd> Widened(const Part& part, MatrixMemory<double>* memory) {
  Eigen::Map<Eigen::MatrixXd> wide = memory->Shape(part.rows(), part.cols());
  wide = part.template cast<double>();
  return wide;
}

/// Calls f(first, count) on parts of a block's rows, of which Eigen's products keep their copies on
/// the stack. @param num_columns Of the larger factor.
template <typename Function>
void ForParts(Index num_rows, Index num_columns, const Function& f) {
  constexpr Index kLargestCopy = EIGEN_STACK_ALLOCATION_LIMIT / sizeof(double);
  const Index most = std::max(Index{1}, kLargestCopy / num_columns);
  const Index num_parts = (num_rows + most - 1) / most;
  for (Index part = 0; part < num_parts; ++part) {
    const Index first = part * num_rows / num_parts;
    f(first, (part + 1) * num_rows / num_parts - first);
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
  Eigen::Map<Eigen::MatrixXd> sorted = sorted_.Shape(num_columns(), num_columns());
  sorted.setZero();
  std::visit(
      [&](const auto& numbers) {
        for (const Block& block : blocks_) {
          const auto values = Values(numbers.values, block);
          auto target =
              sorted.block(block.column, block.column, block.num_columns, block.num_columns);
          ForParts(block.num_rows, block.num_columns, [&](Index first, Index count) {
            target.template selfadjointView<Eigen::Lower>().rankUpdate(
                Widened(values.middleCols(first, count), &wide_));
          });
        }
      },
      numbers_);
  sorted.triangularView<Eigen::StrictlyUpper>() = sorted.transpose();
  PutInGivenOrder(sorted, *this, gram);
}

void EliminatedColumns::TransposeTimes(const EliminatedColumns& other,
                                       // NOLINTNEXTLINE(performance-unnecessary-value-param)
                                       Eigen::Ref<Eigen::MatrixXd> product) const {
  Eigen::Map<Eigen::MatrixXd> sorted = sorted_.Shape(num_columns(), other.num_columns());
  sorted.setZero();
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
          auto target =
              sorted.block(ours.column, theirs->column, ours.num_columns, theirs->num_columns);
          ForParts(ours.num_rows, std::max(ours.num_columns, theirs->num_columns),
                   [&](Index first, Index count) {
                     target.noalias() +=
                         Widened(values.middleCols(first, count), &wide_) *
                         Widened(their_values.middleCols(first, count), &their_wide_).transpose();
                   });
        }
      },
      numbers_);
  PutInGivenOrder(sorted, other, product);
}

void EliminatedColumns::PutInGivenOrder(const Eigen::Ref<const Eigen::MatrixXd>& sorted,
                                        const EliminatedColumns& other,
                                        Eigen::Ref<Eigen::MatrixXd> product) const {
  for (Index j = 0; j < sorted.cols(); ++j) {
    const int column = other.order_[static_cast<std::size_t>(j)];
    for (Index i = 0; i < sorted.rows(); ++i) {
      product(order_[static_cast<std::size_t>(i)], column) = sorted(i, j);
    }
  }
}

}  // namespace vacuum_gripper_sim
