#include "vacuum_gripper_sim/core/mcp_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

/// max_i |min(delta_i, lambda_i W_ii)|: 0 exactly where the complementarity conditions hold.
double Residual(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta_end,
                const Eigen::VectorXd& lambda) {
  if (lambda.size() == 0) return 0.0;
  return delta_end.cwiseMin(W.diagonal().cwiseProduct(lambda)).cwiseAbs().maxCoeff();
}

McpStatistics GaussSeidel(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                          const ContactParameters& parameters, Eigen::VectorXd* lambda) {
  McpStatistics statistics;
  *lambda = lambda->cwiseMax(0.0);
  Eigen::VectorXd delta_end = delta + W * *lambda;
  statistics.residual = Residual(W, delta_end, *lambda);
  while (statistics.residual > parameters.tolerance &&
         statistics.iterations < parameters.max_iterations) {
    for (Eigen::Index i = 0; i < lambda->size(); ++i) {
      const double old = (*lambda)(i);
      (*lambda)(i) = std::max(0.0, old - parameters.relaxation * delta_end(i) / W(i, i));
      const double change = (*lambda)(i)-old;
      if (change != 0.0) delta_end.noalias() += change * W.col(i);
    }
    ++statistics.iterations;
    statistics.residual = Residual(W, delta_end, *lambda);
  }
  statistics.converged = statistics.residual <= parameters.tolerance;
  return statistics;
}

/// The forces that close the gaps of the contacts in `active`, zero elsewhere.
void SetForcesOfActive(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                       const std::vector<Eigen::Index>& active, Eigen::VectorXd* lambda) {
  const auto size = static_cast<Eigen::Index>(active.size());
  Eigen::MatrixXd W_active(size, size);
  Eigen::VectorXd right(size);
  for (Eigen::Index j = 0; j < size; ++j) {
    const Eigen::Index column = active[static_cast<std::size_t>(j)];
    right(j) = -delta(column);
    for (Eigen::Index i = j; i < size; ++i) {
      W_active(i, j) = W(active[static_cast<std::size_t>(i)], column);
    }
    W_active(j, j) *= 1.0 + kContactRegularization;
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(W_active);  // in its place
  factor.solveInPlace(right);
  lambda->setZero();
  for (Eigen::Index j = 0; j < size; ++j) (*lambda)(active[static_cast<std::size_t>(j)]) = right(j);
}

McpStatistics ActiveSet(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                        const ContactParameters& parameters, Eigen::VectorXd* lambda) {
  // Full exchanges allowed without a new record low of violations.
  constexpr int kPatience = 5;
  const Eigen::Index size = delta.size();
  std::vector<bool> is_active(static_cast<std::size_t>(size));
  for (Eigen::Index i = 0; i < size; ++i) {
    is_active[static_cast<std::size_t>(i)] = (*lambda)(i) > 0.0;
  }

  McpStatistics statistics;
  std::size_t record = static_cast<std::size_t>(size) + 1;
  int patience = kPatience;
  std::vector<Eigen::Index> active, violations;
  active.reserve(static_cast<std::size_t>(size));
  Eigen::VectorXd delta_end;
  while (true) {
    active.clear();
    for (Eigen::Index i = 0; i < size; ++i) {
      if (is_active[static_cast<std::size_t>(i)]) active.push_back(i);
    }
    SetForcesOfActive(W, delta, active, lambda);
    delta_end = delta;
    for (const Eigen::Index i : active) delta_end.noalias() += (*lambda)(i)*W.col(i);
    ++statistics.iterations;

    // Signs are decided well below the tolerance, so that it holds for the residual.
    const double threshold = 0.1 * parameters.tolerance;
    violations.clear();
    for (Eigen::Index i = 0; i < size; ++i) {
      const double violation =
          is_active[static_cast<std::size_t>(i)] ? -(*lambda)(i)*W(i, i) : -delta_end(i);
      if (violation > threshold) violations.push_back(i);
    }
    if (violations.empty() || statistics.iterations >= parameters.max_iterations) {
      *lambda = lambda->cwiseMax(0.0);
      delta_end = delta;
      delta_end.noalias() += W * *lambda;
      statistics.residual = Residual(W, delta_end, *lambda);
      statistics.converged = statistics.residual <= parameters.tolerance;
      return statistics;
    }
    if (violations.size() < record) {
      record = violations.size();
      patience = kPatience;
    } else if (patience > 0) {
      --patience;
    } else {
      violations = {violations.back()};
    }
    for (const Eigen::Index i : violations) {
      is_active[static_cast<std::size_t>(i)] = !is_active[static_cast<std::size_t>(i)];
    }
  }
}

}  // namespace

Eigen::LLT<Eigen::MatrixXd> FactorOfContacts(const Eigen::MatrixXd& W_lower, double* share) {
  Eigen::LLT<Eigen::MatrixXd> factor;
  for (*share = kContactRegularization; *share < 1e-5; *share *= 1e3) {
    Eigen::MatrixXd W = W_lower;
    W.diagonal() *= 1.0 + *share;
    factor.compute(W);
    if (factor.info() == Eigen::Success) break;
  }
  return factor;
}

McpStatistics SolveContacts(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                            const ContactParameters& parameters, Eigen::VectorXd* lambda) {
  if (W.rows() != delta.size() || W.cols() != delta.size() || lambda->size() != delta.size()) {
    throw std::invalid_argument("SolveContacts: W, delta and lambda must have the same size");
  }
  return parameters.method == ContactSolverMethod::kActiveSet
             ? ActiveSet(W, delta, parameters, lambda)
             : GaussSeidel(W, delta, parameters, lambda);
}

}  // namespace vacuum_gripper_sim
