#pragma once

#include <Eigen/Core>
#include <vector>

namespace vacuum_gripper_sim {

/** Cholesky factor of some rows and columns of W, the compliance of contacts.

 Two contacts in one direction at one node make W singular. A diagonal larger by some share splits
 their force evenly and moves no gap by more than that share of itself: 1e-12, or more where
 rounding wants it. */
class ContactFactor {
 public:
  /// @param W Symmetric. [m/N] @param rows Of it, W's first one being called `first`.
  /// @returns false if there is no factor.
  bool Compute(const Eigen::MatrixXd& W, const std::vector<Eigen::Index>& rows,
               Eigen::Index first = 0);
  /// By which the diagonal is larger. [-]
  double share() const { return share_; }

  /// x becomes what solves W x. @param[in,out] x As many rows as Compute() had.
  template <typename Vectors>
  void SolveInPlace(Vectors* x) const {
    const auto L = L_.topLeftCorner(x->rows(), x->rows());
    L.template triangularView<Eigen::Lower>().solveInPlace(*x);
    L.transpose().template triangularView<Eigen::Upper>().solveInPlace(*x);
  }

 private:
  Eigen::MatrixXd L_;  // with room for more contacts
  double share_{0.0};
};

}  // namespace vacuum_gripper_sim
