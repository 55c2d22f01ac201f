#include "vacuum_gripper_sim/core/eliminated_columns.h"

#include <algorithm>
#include <type_traits>

namespace vacuum_gripper_sim {

using Eigen::Index;

namespace {

template <typename Values>
using ScalarOf = typename std::decay_t<Values>::value_type;

/// Blocks in double precision, one after the other in the same memory.
class WideBlock {
 public:
  explicit WideBlock(std::size_t capacity) : memory_(capacity) {}

  template <typename Block>
  Eigen::Map<const Eigen::MatrixXd> operator()(const Block& block) {
    Eigen::Map<Eigen::MatrixXd>(memory_.data(), block.rows(), block.cols()) =
        block.template cast<double>();
    return {memory_.data(), block.rows(), block.cols()};
  }

 private:
  std::vector<double> memory_;
};

}  // namespace

std::size_t EliminatedColumns::LargestBlock() const {
  Index largest = 0;
  for (const Block& block : blocks_)
    largest = std::max(largest, block.num_rows * block.num_columns);
  return static_cast<std::size_t>(largest);
}

Index EliminatedColumns::MostRows() const {
  Index most = 0;
  for (const Block& block : blocks_) most = std::max(most, block.num_rows);
  return most;
}

Eigen::VectorXd EliminatedColumns::TransposeTimes(const Eigen::VectorXd& y) const {
  return std::visit(
      [&](const auto& values) -> Eigen::VectorXd {
        using Vector = Eigen::Matrix<ScalarOf<decltype(values)>, Eigen::Dynamic, 1>;
        Vector sorted = Vector::Zero(num_columns());
        Vector work(MostRows());
        for (const Block& block : blocks_) {
          auto rows = work.head(block.num_rows);
          rows = y.segment(block.row, block.num_rows).template cast<typename Vector::Scalar>();
          sorted.segment(block.column, block.num_columns).noalias() += Values(values, block) * rows;
        }
        Eigen::VectorXd result(num_columns());
        for (Index k = 0; k < result.size(); ++k) {
          result(order_[static_cast<std::size_t>(k)]) = sorted(k);
        }
        return result;
      },
      values_);
}

void EliminatedColumns::AddTimes(const Eigen::VectorXd& x, Eigen::VectorXd* y) const {
  std::visit(
      [&](const auto& values) {
        using Vector = Eigen::Matrix<ScalarOf<decltype(values)>, Eigen::Dynamic, 1>;
        Vector sorted(num_columns());
        for (Index k = 0; k < sorted.size(); ++k) {
          sorted(k) = static_cast<typename Vector::Scalar>(x(order_[static_cast<std::size_t>(k)]));
        }
        Vector work(MostRows());
        for (const Block& block : blocks_) {
          auto rows = work.head(block.num_rows);
          rows.noalias() =
              Values(values, block).transpose() * sorted.segment(block.column, block.num_columns);
          y->segment(block.row, block.num_rows) += rows.template cast<double>();
        }
      },
      values_);
}

/// In double precision whatever Y's: contacts at one node differ by less than single rounding.
Eigen::MatrixXd EliminatedColumns::Gram() const {
  Eigen::MatrixXd sorted = Eigen::MatrixXd::Zero(num_columns(), num_columns());
  WideBlock wide(LargestBlock());
  std::visit(
      [&](const auto& values) {
        for (const Block& block : blocks_) {
          sorted.block(block.column, block.column, block.num_columns, block.num_columns)
              .selfadjointView<Eigen::Lower>()
              .rankUpdate(wide(Values(values, block)));
        }
      },
      values_);
  sorted.triangularView<Eigen::StrictlyUpper>() = sorted.transpose();
  return InGivenOrder(sorted, *this);
}

Eigen::MatrixXd EliminatedColumns::TransposeTimes(const EliminatedColumns& other) const {
  Eigen::MatrixXd sorted = Eigen::MatrixXd::Zero(num_columns(), other.num_columns());
  WideBlock wide(LargestBlock()), their_wide(other.LargestBlock());
  std::visit(
      [&](const auto& values) {
        const auto& their_values = std::get<std::decay_t<decltype(values)>>(other.values_);
        auto theirs = other.blocks_.begin();
        for (const Block& ours : blocks_) {
          while (theirs != other.blocks_.end() && theirs->row < ours.row) ++theirs;
          if (theirs == other.blocks_.end()) break;
          if (theirs->row != ours.row) continue;
          sorted.block(ours.column, theirs->column, ours.num_columns, theirs->num_columns)
              .noalias() +=
              wide(Values(values, ours)) * their_wide(Values(their_values, *theirs)).transpose();
        }
      },
      values_);
  return InGivenOrder(sorted, other);
}

Eigen::MatrixXd EliminatedColumns::InGivenOrder(const Eigen::MatrixXd& sorted,
                                                const EliminatedColumns& other) const {
  Eigen::MatrixXd result(sorted.rows(), sorted.cols());
  for (Index j = 0; j < sorted.cols(); ++j) {
    const int column = other.order_[static_cast<std::size_t>(j)];
    for (Index i = 0; i < sorted.rows(); ++i) {
      result(order_[static_cast<std::size_t>(i)], column) = sorted(i, j);
    }
  }
  return result;
}

}  // namespace vacuum_gripper_sim
