#include "vacuum_gripper_sim/core/eliminated_columns.h"

namespace vacuum_gripper_sim {

using Eigen::Index;

Eigen::VectorXd EliminatedColumns::TransposeTimes(const Eigen::VectorXd& y) const {
  Eigen::VectorXd sorted = Eigen::VectorXd::Zero(num_columns());
  for (const Block& block : blocks_) {
    sorted.segment(block.column, block.num_columns).noalias() +=
        Values(block) * y.segment(block.row, block.num_rows);
  }
  Eigen::VectorXd result(num_columns());
  for (Index k = 0; k < result.size(); ++k) result(order_[static_cast<std::size_t>(k)]) = sorted(k);
  return result;
}

void EliminatedColumns::AddTimes(const Eigen::VectorXd& x, Eigen::VectorXd* y) const {
  Eigen::VectorXd sorted(num_columns());
  for (Index k = 0; k < sorted.size(); ++k) sorted(k) = x(order_[static_cast<std::size_t>(k)]);
  for (const Block& block : blocks_) {
    y->segment(block.row, block.num_rows).noalias() +=
        Values(block).transpose() * sorted.segment(block.column, block.num_columns);
  }
}

Eigen::MatrixXd EliminatedColumns::Gram() const {
  Eigen::MatrixXd sorted = Eigen::MatrixXd::Zero(num_columns(), num_columns());
  for (const Block& block : blocks_) {
    sorted.block(block.column, block.column, block.num_columns, block.num_columns)
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(Values(block));
  }
  sorted.triangularView<Eigen::StrictlyUpper>() = sorted.transpose();
  return InGivenOrder(sorted, *this);
}

Eigen::MatrixXd EliminatedColumns::TransposeTimes(const EliminatedColumns& other) const {
  Eigen::MatrixXd sorted = Eigen::MatrixXd::Zero(num_columns(), other.num_columns());
  auto theirs = other.blocks_.begin();
  for (const Block& ours : blocks_) {
    while (theirs != other.blocks_.end() && theirs->row < ours.row) ++theirs;
    if (theirs == other.blocks_.end()) break;
    if (theirs->row != ours.row) continue;
    sorted.block(ours.column, theirs->column, ours.num_columns, theirs->num_columns).noalias() +=
        Values(ours) * other.Values(*theirs).transpose();
  }
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
