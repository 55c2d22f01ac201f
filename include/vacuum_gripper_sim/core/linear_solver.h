#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"

namespace vacuum_gripper_sim {

/** Solves A y = b for the step's symmetric positive definite A.

 kDirect factorises every A. kConjugateGradient is the way of [Bernardin, Sec. III-A]: conjugate
 gradients with an earlier A's factorisation as preconditioner, renewed every `refactor_interval`
 steps and whenever CG does not reach its tolerance, so that the answer depends on the tolerance and
 not on the factorisation's age. */
class LinearSolver {
 public:
  explicit LinearSolver(const LinearSolverParameters& parameters) : parameters_(parameters) {}

  /** Takes the step's matrix. @param A Lower triangle; must outlive the solves. The sparsity of the
   first call is that of all. @returns false if A is not positive definite. */
  bool Compute(const Eigen::SparseMatrix<double>& A);

  /// Factorises the A of the last Compute(). @returns false if it is not positive definite.
  bool Renew() { return Factorize(); }
  double tolerance() const { return parameters_.tolerance; }

  /// Solves A y = b. With CG, refactors once if the tolerance is not met.
  /// @returns false if it is not met even then.
  bool Solve(const Eigen::VectorXd& b, Eigen::VectorXd* y);

  /// A x, with the A of the last Compute().
  Eigen::VectorXd Times(const Eigen::VectorXd& x) const {
    return A_->selfadjointView<Eigen::Lower>() * x;
  }

  /// The newest factorisation: of A with kDirect, of this or an earlier A with CG.
  const SparseCholesky& factorization() const { return factorization_; }
  /// Does factorization() belong to the A of the last Compute()?
  bool current() const { return age_ == 0; }

  int iterations() const { return iterations_; }          ///< CG, since Compute().
  int factorizations() const { return factorizations_; }  ///< Since Compute().

 private:
  bool Factorize();
  bool ConjugateGradient(const Eigen::VectorXd& b, Eigen::VectorXd* y);

  LinearSolverParameters parameters_;
  const Eigen::SparseMatrix<double>* A_{nullptr};
  SparseCholesky factorization_;
  bool usable_{false};  // does factorization_ hold a factor?
  int age_{0};          // steps since the factorisation
  int iterations_{0};
  int factorizations_{0};
};

}  // namespace vacuum_gripper_sim
