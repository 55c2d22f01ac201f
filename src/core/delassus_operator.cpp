#include "vacuum_gripper_sim/core/delassus_operator.h"

#include <algorithm>
#include <utility>

namespace vacuum_gripper_sim {

using Eigen::Index;

void DelassusOperator::Reset(const SparseCholesky& factorization, double h) {
  factorization_ = &factorization;
  h_ = h;
  H_rows_.clear();
  num_batches_ = 0;
}

void DelassusOperator::Adopt(DelassusOperator* other) {
  if (other->h_ != h_) return;
  H_rows_.swap(other->H_rows_);
  batches_.swap(other->batches_);
  std::swap(num_batches_, other->num_batches_);
  W_.swap(other->W_);
}

void DelassusOperator::SetRows(const std::vector<NodeColumn>& H_rows) {
  if (!ComeFirstIn(H_rows)) Reset(*factorization_, h_);
  new_rows_.assign(H_rows.begin() + num_contacts(), H_rows.end());
  if (!new_rows_.empty()) AppendNew();
}

bool DelassusOperator::ComeFirstIn(const std::vector<NodeColumn>& H_rows) const {
  return H_rows_.size() <= H_rows.size() &&
         std::equal(H_rows_.begin(), H_rows_.end(), H_rows.begin(),
                    [](const NodeColumn& a, const NodeColumn& b) {
                      return a.node == b.node && a.value == b.value;
                    });
}

void DelassusOperator::AppendNew() {
  if (num_batches_ == batches_.size()) batches_.emplace_back();
  EliminatedColumns& Y_new = batches_[num_batches_];
  factorization_->EliminateColumns(new_rows_, &Y_new);
  const Index num_old = num_contacts();
  const Index num_new = Y_new.num_columns();
  if (const Index size = num_old + num_new; size > W_.rows()) {
    const Index with_room = std::max(size, W_.rows() + W_.rows() / 2);
    W_.conservativeResize(with_room, with_room);
  }
  Index row = 0;
  for (std::size_t i = 0; i < num_batches_; ++i) {
    auto beside = W_.block(row, num_old, batches_[i].num_columns(), num_new);
    batches_[i].TransposeTimes(Y_new, beside);
    beside *= h_ * h_;
    W_.block(num_old, row, num_new, beside.rows()) = beside.transpose();
    row += beside.rows();
  }
  auto own = W_.block(num_old, num_old, num_new, num_new);
  Y_new.Gram(own);
  own *= h_ * h_;
  ++num_batches_;
  H_rows_.insert(H_rows_.end(), new_rows_.begin(), new_rows_.end());
}

void DelassusOperator::GapChanges(const Eigen::VectorXd& y,
                                  Eigen::Ref<Eigen::VectorXd> changes) const {
  Index row = 0;
  for (std::size_t i = 0; i < num_batches_; ++i) {
    batches_[i].TransposeTimes(y, changes.segment(row, batches_[i].num_columns()));
    row += batches_[i].num_columns();
  }
  changes *= h_;
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
  for (std::size_t i = 0; i < num_batches_; ++i) {
    batches_[i].AddTimes(h_, lambda.segment(row, batches_[i].num_columns()), y);
    row += batches_[i].num_columns();
  }
}

}  // namespace vacuum_gripper_sim
