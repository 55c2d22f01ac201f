#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/eliminated_columns.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"

namespace vacuum_gripper_sim {

/** The Delassus operator W = h^2 H A^-1 H^T = h^2 Y^T Y, Y = L^-1 P H^T, of contacts that become
 more: new ones cost their own columns of Y and their rows of W.

 The paper leaves the h^2, which makes W displacement [m] over force [N], implicit. Y also serves
 the rest of the step: what an impulse does to the gaps, and what the forces add to the motion, are
 products with it in the middle of the one solve with A. */
class DelassusOperator {
 public:
  /// Starts anew without contacts. @param factorization Of A [kg]; must outlive this.
  /// @param h Time step. [s]
  void Reset(const SparseCholesky& factorization, double h);
  /// Becomes that of these contacts. Those it has already cost nothing if they come first; else it
  /// starts anew. @param H_rows Gradients of their gaps, by node of the free system. [-]
  void SetRows(const std::vector<NodeColumn>& H_rows);
  /// Exchanges contacts with another, whose factor this one has by now; unless its time step is
  /// another one.
  void Adopt(DelassusOperator* other);

  int num_contacts() const { return static_cast<int>(H_rows_.size()); }
  /// #contacts square, symmetric. [m/N]
  Eigen::Block<const Eigen::MatrixXd> W() const {
    return W_.topLeftCorner(num_contacts(), num_contacts());
  }
  /// h H A^-1 b of an impulse b [N s] given as y = L^-1 P b. @param[out] changes #contacts. [m]
  void GapChanges(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> changes) const;
  /// b += h H^T lambda. @param lambda Contact forces. [N] @param[in,out] b [N s]
  void AddImpulses(const Eigen::Ref<const Eigen::VectorXd>& lambda, Eigen::VectorXd* b) const;
  /// y += L^-1 P h H^T lambda. @param lambda Contact forces. [N]
  void AddForces(const Eigen::Ref<const Eigen::VectorXd>& lambda, Eigen::VectorXd* y) const;

 private:
  bool ComeFirstIn(const std::vector<NodeColumn>& H_rows) const;
  void AppendNew();

  const SparseCholesky* factorization_{nullptr};
  double h_{0.0};
  std::vector<NodeColumn> H_rows_, new_rows_;
  std::vector<EliminatedColumns> batches_;  // Y, in the order of the contacts; the first ones count
  std::size_t num_batches_{0};
  Eigen::MatrixXd W_;  // with room for more contacts
};

}  // namespace vacuum_gripper_sim
