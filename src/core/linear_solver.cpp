#include "vacuum_gripper_sim/core/linear_solver.h"

namespace vacuum_gripper_sim {

bool LinearSolver::Compute(const Eigen::SparseMatrix<double>& A) {
  A_ = &A;
  iterations_ = 0;
  factorizations_ = 0;
  const bool reuse = parameters_.method == LinearSolverMethod::kConjugateGradient && usable_ &&
                     age_ + 1 < parameters_.refactor_interval;
  if (reuse) {
    ++age_;
    return true;
  }
  return Factorize();
}

bool LinearSolver::Factorize() {
  if (!factorization_.analyzed()) factorization_.Analyze(*A_);
  usable_ = factorization_.Factorize(*A_);
  age_ = 0;
  ++factorizations_;
  return usable_;
}

bool LinearSolver::Solve(const Eigen::VectorXd& b, Eigen::VectorXd* y) {
  if (parameters_.method == LinearSolverMethod::kDirect) {
    *y = factorization_.Solve(b);
    return true;
  }
  if (ConjugateGradient(b, y)) return true;
  return !current() && Factorize() && ConjugateGradient(b, y);
}

bool LinearSolver::ConjugateGradient(const Eigen::VectorXd& b, Eigen::VectorXd* y) {
  const auto A = A_->selfadjointView<Eigen::Lower>();
  const double bound = parameters_.tolerance * b.norm();
  *y = factorization_.Solve(b);
  Eigen::VectorXd r = b - A * *y;
  if (r.norm() <= bound) return true;
  Eigen::VectorXd z = factorization_.Solve(r);
  Eigen::VectorXd p = z;
  double rz = r.dot(z);
  for (int i = 0; i < parameters_.max_iterations; ++i) {
    ++iterations_;
    const Eigen::VectorXd Ap = A * p;
    const double step = rz / p.dot(Ap);
    *y += step * p;
    r -= step * Ap;
    if (r.norm() <= bound) return true;
    z = factorization_.Solve(r);
    const double rz_next = r.dot(z);
    p = z + (rz_next / rz) * p;
    rz = rz_next;
  }
  return false;
}

}  // namespace vacuum_gripper_sim
