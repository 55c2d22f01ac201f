#include "vacuum_gripper_sim/core/mcp_solver.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

/// max_i |min(delta_i, lambda_i W_ii)|: 0 exactly where the complementarity conditions hold.
double Residual(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta_end,
                const Eigen::VectorXd& lambda) {
  if (lambda.size() == 0) return 0.0;
  return delta_end.cwiseMin(W.diagonal().cwiseProduct(lambda)).cwiseAbs().maxCoeff();
}

}  // namespace

McpStatistics McpSolver::SolveByGaussSeidel(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                                            const ContactParameters& parameters,
                                            Eigen::VectorXd* lambda) {
  McpStatistics statistics;
  *lambda = lambda->cwiseMax(0.0);
  delta_end_ = delta;
  delta_end_.noalias() += W * *lambda;
  statistics.residual = Residual(W, delta_end_, *lambda);
  while (statistics.residual > parameters.tolerance &&
         statistics.iterations < parameters.max_iterations) {
    for (Eigen::Index i = 0; i < lambda->size(); ++i) {
      const double old = (*lambda)(i);
      (*lambda)(i) = std::max(0.0, old - parameters.relaxation * delta_end_(i) / W(i, i));
      const double change = (*lambda)(i)-old;
      if (change != 0.0) delta_end_.noalias() += change * W.col(i);
    }
    ++statistics.iterations;
    statistics.residual = Residual(W, delta_end_, *lambda);
  }
  statistics.converged = statistics.residual <= parameters.tolerance;
  return statistics;
}

/// The forces that close the gaps of the active contacts, zero elsewhere.
void McpSolver::SetForcesOfActive(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                                  Eigen::VectorXd* lambda) {
  const auto size = static_cast<Eigen::Index>(active_.size());
  forces_.resize(delta.size());
  auto forces = forces_.head(size);
  for (Eigen::Index j = 0; j < size; ++j) forces(j) = -delta(active_[static_cast<std::size_t>(j)]);
  factor_.Compute(W, active_);
  factor_.SolveInPlace(&forces);
  lambda->setZero();
  for (Eigen::Index j = 0; j < size; ++j) {
    (*lambda)(active_[static_cast<std::size_t>(j)]) = forces(j);
  }
}

McpStatistics McpSolver::SolveByActiveSet(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                                          const ContactParameters& parameters,
                                          Eigen::VectorXd* lambda) {
  // Full exchanges allowed without a new record low of violations.
  constexpr int kPatience = 5;
  const Eigen::Index size = delta.size();
  is_active_.resize(static_cast<std::size_t>(size));
  for (Eigen::Index i = 0; i < size; ++i) {
    is_active_[static_cast<std::size_t>(i)] = (*lambda)(i) > 0.0;
  }

  McpStatistics statistics;
  std::size_t record = static_cast<std::size_t>(size) + 1;
  int patience = kPatience;
  while (true) {
    active_.clear();
    for (Eigen::Index i = 0; i < size; ++i) {
      if (is_active_[static_cast<std::size_t>(i)]) active_.push_back(i);
    }
    SetForcesOfActive(W, delta, lambda);
    delta_end_ = delta;
    for (const Eigen::Index i : active_) delta_end_.noalias() += (*lambda)(i)*W.col(i);
    ++statistics.iterations;

    // Signs are decided well below the tolerance, so that it holds for the residual.
    const double threshold = 0.1 * parameters.tolerance;
    violations_.clear();
    for (Eigen::Index i = 0; i < size; ++i) {
      const double violation =
          is_active_[static_cast<std::size_t>(i)] ? -(*lambda)(i)*W(i, i) : -delta_end_(i);
      if (violation > threshold) violations_.push_back(i);
    }
    if (violations_.empty() || statistics.iterations >= parameters.max_iterations) {
      *lambda = lambda->cwiseMax(0.0);
      delta_end_ = delta;
      delta_end_.noalias() += W * *lambda;
      statistics.residual = Residual(W, delta_end_, *lambda);
      statistics.converged = statistics.residual <= parameters.tolerance;
      return statistics;
    }
    if (violations_.size() < record) {
      record = violations_.size();
      patience = kPatience;
    } else if (patience > 0) {
      --patience;
    } else {
      violations_.erase(violations_.begin(), violations_.end() - 1);
    }
    for (const Eigen::Index i : violations_) {
      is_active_[static_cast<std::size_t>(i)] = !is_active_[static_cast<std::size_t>(i)];
    }
  }
}

McpStatistics McpSolver::Solve(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                               const ContactParameters& parameters, Eigen::VectorXd* lambda) {
  if (W.rows() != delta.size() || W.cols() != delta.size() || lambda->size() != delta.size()) {
    throw std::invalid_argument("McpSolver: W, delta and lambda must have the same size");
  }
  return parameters.method == ContactSolverMethod::kActiveSet
             ? SolveByActiveSet(W, delta, parameters, lambda)
             : SolveByGaussSeidel(W, delta, parameters, lambda);
}

}  // namespace vacuum_gripper_sim
