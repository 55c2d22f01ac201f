#include "vacuum_gripper_sim/core/friction_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Sweeps after a Newton step that failed.
constexpr int kRescueSweeps = 20;
/// Times that a Newton step may be halved.
constexpr int kMaxHalvings = 4;

Vector2d ProjectOntoDisc(const Vector2d& z, double radius) {
  const double size = z.norm();
  return size <= radius ? z : Vector2d(z * (radius / size));
}

class FrictionProblem {
 public:
  FrictionProblem(const Eigen::MatrixXd& W, const VectorXd& delta,
                  const std::vector<ContactRows>& rows)
      : W_(&W), delta_(&delta), rows_(&rows) {}

  /// Gaps and slips under the forces. [m]
  VectorXd End(const VectorXd& lambda) const { return *delta_ + *W_ * lambda; }
  double Residual(const VectorXd& lambda, const VectorXd& end) const;
  void Sweep(double relaxation, VectorXd* lambda, VectorXd* end) const;
  VectorXd NewtonTarget(const VectorXd& lambda, const VectorXd& end) const;

 private:
  double NormalScale(const ContactRows& contact) const {
    return (*W_)(contact.normal, contact.normal);
  }
  double TangentScale(const ContactRows& contact) const {
    const Index t = contact.tangent();
    return 0.5 * ((*W_)(t, t) + (*W_)(t + 1, t + 1));
  }

  const Eigen::MatrixXd* W_;
  const VectorXd* delta_;
  const std::vector<ContactRows>* rows_;
};

double FrictionProblem::Residual(const VectorXd& lambda, const VectorXd& end) const {
  double residual = 0.0;
  for (const ContactRows& contact : *rows_) {
    const Index n = contact.normal;
    residual = std::max(residual, std::abs(std::min(end(n), NormalScale(contact) * lambda(n))));
    if (!contact.has_tangents()) continue;
    const double scale = TangentScale(contact);
    const Vector2d force = lambda.segment<2>(contact.tangent());
    const Vector2d projected = ProjectOntoDisc(force - end.segment<2>(contact.tangent()) / scale,
                                               contact.friction * std::max(0.0, lambda(n)));
    residual = std::max(residual, scale * (force - projected).norm());
  }
  return residual;
}

/// One sweep of projected Gauss-Seidel.
void FrictionProblem::Sweep(double relaxation, VectorXd* lambda, VectorXd* end) const {
  for (const ContactRows& contact : *rows_) {
    const Index n = contact.normal;
    const double before = (*lambda)(n);
    (*lambda)(n) = std::max(0.0, before - relaxation * (*end)(n) / NormalScale(contact));
    if ((*lambda)(n) != before) end->noalias() += ((*lambda)(n)-before) * W_->col(n);
    if (!contact.has_tangents()) continue;
    const Index t = contact.tangent();
    const Vector2d force = lambda->segment<2>(t);
    lambda->segment<2>(t) =
        ProjectOntoDisc(force - relaxation * end->segment<2>(t) / TangentScale(contact),
                        contact.friction * (*lambda)(n));
    const Vector2d change = lambda->segment<2>(t) - force;
    if (!change.isZero(0.0)) end->noalias() += W_->middleCols<2>(t) * change;
  }
}

/// The forces to which a full Newton step leads: zero where contacts open, and of the closed ones
/// those of the linearised projections.
VectorXd FrictionProblem::NewtonTarget(const VectorXd& lambda, const VectorXd& end) const {
  std::vector<const ContactRows*> closed;
  std::vector<Index> unknowns;  // rows of W
  for (const ContactRows& contact : *rows_) {
    const Index n = contact.normal;
    if (NormalScale(contact) * lambda(n) - end(n) <= 0.0) continue;
    closed.push_back(&contact);
    for (Index i = 0; i < (contact.has_tangents() ? 3 : 1); ++i) unknowns.push_back(n + i);
  }
  const auto size = static_cast<Index>(unknowns.size());
  VectorXd target = VectorXd::Zero(lambda.size());
  if (size == 0) return target;

  const auto row_of = [&](Index i) { return unknowns[static_cast<std::size_t>(i)]; };
  Eigen::MatrixXd A(size, size);
  VectorXd right(size);
  VectorXd without_open(size);  // W lambda, of closed contacts
  for (Index j = 0; j < size; ++j) {
    for (Index i = 0; i < size; ++i) A(i, j) = (*W_)(row_of(i), row_of(j));
    A(j, j) *= 1.0 + kContactRegularization;
    right(j) = -(*delta_)(row_of(j));
  }
  VectorXd now(size);
  for (Index i = 0; i < size; ++i) now(i) = lambda(row_of(i));
  without_open.noalias() = A * now;

  Index i = 0;
  for (const ContactRows* contact : closed) {
    if (!contact->has_tangents()) {
      ++i;
      continue;
    }
    const double scale = TangentScale(*contact);
    const Vector2d force = now.segment<2>(i + 1);
    const Vector2d z = force - end.segment<2>(contact->tangent()) / scale;
    const double size_of_z = z.norm();
    const double radius = contact->friction * std::max(0.0, now(i));
    if (size_of_z > radius) {
      // lambda_t - mu lambda_n d - theta P (lambda_t - W_t lambda / W_tt) stays what it is at
      // `now` in its last term, d and P = 1 - d d^T being those of z; times W_tt, as W's rows.
      const Vector2d d = z / size_of_z;
      const Matrix2d P_theta = (radius / size_of_z) * (Matrix2d::Identity() - d * d.transpose());
      right.segment<2>(i + 1) = -P_theta * (scale * force - without_open.segment<2>(i + 1));
      A.middleRows<2>(i + 1) = (P_theta * A.middleRows<2>(i + 1)).eval();
      A.block<2, 2>(i + 1, i + 1) += scale * (Matrix2d::Identity() - P_theta);
      A.block<2, 1>(i + 1, i) -= scale * contact->friction * d;
    }
    i += 3;
  }
  const VectorXd forces = A.partialPivLu().solve(right);
  for (Index k = 0; k < size; ++k) target(row_of(k)) = forces(k);
  return target;
}

McpStatistics GaussSeidel(const FrictionProblem& problem, const ContactParameters& parameters,
                          VectorXd* lambda) {
  McpStatistics statistics;
  VectorXd end = problem.End(*lambda);
  statistics.residual = problem.Residual(*lambda, end);
  while (statistics.residual > parameters.tolerance &&
         statistics.iterations < parameters.max_iterations) {
    problem.Sweep(parameters.relaxation, lambda, &end);
    ++statistics.iterations;
    statistics.residual = problem.Residual(*lambda, end);
  }
  return statistics;
}

McpStatistics Newton(const FrictionProblem& problem, const ContactParameters& parameters,
                     VectorXd* lambda) {
  McpStatistics statistics;
  VectorXd end = problem.End(*lambda);
  statistics.residual = problem.Residual(*lambda, end);
  VectorXd best = *lambda;
  double best_residual = statistics.residual;
  bool first = true;
  while (statistics.residual > parameters.tolerance &&
         statistics.iterations < parameters.max_iterations) {
    const VectorXd step = problem.NewtonTarget(*lambda, end) - *lambda;
    ++statistics.iterations;
    const VectorXd start = *lambda;
    const double start_residual = statistics.residual;
    double share = 1.0;
    for (int halvings = 0; halvings <= kMaxHalvings; ++halvings, share *= 0.5) {
      *lambda = start + share * step;
      end = problem.End(*lambda);
      statistics.residual = problem.Residual(*lambda, end);
      // The first full step may leave the warm start for another set of contacts.
      if (statistics.residual < start_residual || (first && std::isfinite(statistics.residual))) {
        break;
      }
    }
    first = false;
    if (!(statistics.residual < start_residual)) {
      if (!std::isfinite(statistics.residual)) *lambda = start;
      end = problem.End(*lambda);
      for (int sweep = 0; sweep < kRescueSweeps; ++sweep) problem.Sweep(1.0, lambda, &end);
      end = problem.End(*lambda);
      statistics.residual = problem.Residual(*lambda, end);
    }
    if (statistics.residual < best_residual) {
      best_residual = statistics.residual;
      best = *lambda;
    }
  }
  *lambda = best;
  statistics.residual = best_residual;
  return statistics;
}

}  // namespace

McpStatistics SolveFrictionalContacts(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                                      const std::vector<ContactRows>& rows,
                                      const ContactParameters& parameters,
                                      Eigen::VectorXd* lambda) {
  const Index size = delta.size();
  Index covered = 0;
  for (const ContactRows& contact : rows) covered += contact.has_tangents() ? 3 : 1;
  if (W.rows() != size || W.cols() != size || lambda->size() != size || covered != size) {
    throw std::invalid_argument(
        "SolveFrictionalContacts: W, delta, lambda and the contacts' rows must agree in size");
  }
  const FrictionProblem problem(W, delta, rows);
  McpStatistics statistics = parameters.method == ContactSolverMethod::kActiveSet
                                 ? Newton(problem, parameters, lambda)
                                 : GaussSeidel(problem, parameters, lambda);
  statistics.converged = statistics.residual <= parameters.tolerance;
  return statistics;
}

}  // namespace vacuum_gripper_sim
