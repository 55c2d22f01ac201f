#include "vacuum_gripper_sim/core/delassus_operator.h"

#include <utility>

namespace vacuum_gripper_sim {

using Eigen::Index;

void DelassusOperator::Reset(const SparseCholesky& factorization, double h) {
  factorization_ = &factorization;
  h_ = h;
  H_rows_.clear();
  batches_.clear();
  W_.resize(0, 0);
}

void DelassusOperator::Append(const std::vector<NodeColumn>& H_rows) {
  if (H_rows.empty()) return;
  EliminatedColumns Y_new = factorization_->EliminateColumns(H_rows);
  const Index num_old = W_.rows();
  const Index num_new = Y_new.num_columns();
  W_.conservativeResize(num_old + num_new, num_old + num_new);
  Index row = 0;
  for (const EliminatedColumns& Y : batches_) {
    const Index num_rows = Y.num_columns();
    W_.block(row, num_old, num_rows, num_new) = h_ * h_ * Y.TransposeTimes(Y_new);
    W_.block(num_old, row, num_new, num_rows) =
        W_.block(row, num_old, num_rows, num_new).transpose();
    row += num_rows;
  }
  W_.bottomRightCorner(num_new, num_new) = h_ * h_ * Y_new.Gram();
  batches_.push_back(std::move(Y_new));
  H_rows_.insert(H_rows_.end(), H_rows.begin(), H_rows.end());
}

Eigen::VectorXd DelassusOperator::GapChanges(const Eigen::VectorXd& y) const {
  Eigen::VectorXd changes(num_contacts());
  Index row = 0;
  for (const EliminatedColumns& Y : batches_) {
    changes.segment(row, Y.num_columns()) = h_ * Y.TransposeTimes(y);
    row += Y.num_columns();
  }
  return changes;
}

void DelassusOperator::AddImpulses(const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                   Eigen::VectorXd* b) const {
  for (Index i = 0; i < num_contacts(); ++i) {
    const NodeColumn& row = H_rows_[static_cast<std::size_t>(i)];
    b->segment<3>(3 * row.node) += h_ * lambda(i) * row.value;
  }
}

void DelassusOperator::AddForces(const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                 Eigen::VectorXd* y) const {
  Index row = 0;
  for (const EliminatedColumns& Y : batches_) {
    Y.AddTimes(h_ * lambda.segment(row, Y.num_columns()), y);
    row += Y.num_columns();
  }
}

}  // namespace vacuum_gripper_sim
