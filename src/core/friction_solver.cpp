#include "vacuum_gripper_sim/core/friction_solver.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Sweeps after the first Newton step that failed; twice as many after the next one, and so on.
constexpr int kFirstRescue = 20;
constexpr int kLargestRescue = 1280;
/// Times that a Newton step may be halved.
constexpr int kMaxHalvings = 4;
/// Newton steps without a tenth less residual after which an acceptable result is not improved on:
/// of many contacts between two rigid bodies, forces are not unique, and steps may go in circles.
constexpr int kPatience = 10;

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
  bool Slides(const ContactRows& contact, const VectorXd& lambda, const VectorXd& end) const;
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
  // A largest value would pass over what is no number.
  if (!lambda.allFinite() || !end.allFinite()) return std::numeric_limits<double>::infinity();
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

bool FrictionProblem::Slides(const ContactRows& contact, const VectorXd& lambda,
                             const VectorXd& end) const {
  const Vector2d z = lambda.segment<2>(contact.tangent()) -
                     end.segment<2>(contact.tangent()) / TangentScale(contact);
  return z.norm() > contact.friction * std::max(0.0, lambda(contact.normal));
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

/** The forces to which a full Newton step leads: zero where contacts open, and of the closed ones
 those of the linearised projections. Rows that keep their gap or slip at zero (E) are W's own and
 symmetric; those of sliding tangents (S) are eliminated after them. */
VectorXd FrictionProblem::NewtonTarget(const VectorXd& lambda, const VectorXd& end) const {
  std::vector<Index> held;                  // rows of W in E
  std::vector<const ContactRows*> sliding;  // their tangents are S
  for (const ContactRows& contact : *rows_) {
    if (NormalScale(contact) * lambda(contact.normal) - end(contact.normal) <= 0.0) continue;
    held.push_back(contact.normal);
    if (!contact.has_tangents()) continue;
    if (Slides(contact, lambda, end)) {
      sliding.push_back(&contact);
    } else {
      held.push_back(contact.tangent());
      held.push_back(contact.tangent() + 1);
    }
  }
  VectorXd target = VectorXd::Zero(lambda.size());
  const auto num_held = static_cast<Index>(held.size());
  const auto num_sliding = 2 * static_cast<Index>(sliding.size());
  if (num_held == 0) return target;

  // W_EE (forces of E) = right_E - W_ES (forces of S)
  MatrixXd W_EE(num_held, num_held);
  MatrixXd right(num_held, num_sliding + 1);
  for (Index i = 0; i < num_held; ++i) {
    const Index row = held[static_cast<std::size_t>(i)];
    for (Index j = 0; j <= i; ++j) {
      W_EE(i, j) = (*W_)(row, held[static_cast<std::size_t>(j)]);
    }
    for (Index s = 0; s < num_sliding; s += 2) {
      right.block<1, 2>(i, s) =
          W_->block<1, 2>(row, sliding[static_cast<std::size_t>(s / 2)]->tangent());
    }
    right(i, num_sliding) = -(*delta_)(row);
  }
  const Eigen::LLT<MatrixXd> factor = FactorOfContacts(W_EE);
  if (factor.info() != Eigen::Success) return lambda;
  factor.solveInPlace(right);
  VectorXd forces_E = right.col(num_sliding);

  if (num_sliding > 0) {
    MatrixXd B_SE(num_sliding, num_held);
    MatrixXd B_SS(num_sliding, num_sliding);
    VectorXd right_S(num_sliding);
    for (Index s = 0; s < num_sliding; s += 2) {
      const ContactRows& contact = *sliding[static_cast<std::size_t>(s / 2)];
      const Index t = contact.tangent();
      const double scale = TangentScale(contact);
      const Vector2d force = lambda.segment<2>(t);
      const Vector2d z = force - end.segment<2>(t) / scale;
      const double size_of_z = z.norm();
      const double radius = contact.friction * std::max(0.0, lambda(contact.normal));
      // lambda_t - mu lambda_n d - theta P (lambda_t - W_t lambda / W_tt), where d, P = 1 - d d^T
      // and theta are those of z, keeps its last term; times W_tt, as W's rows.
      const Vector2d d = z / size_of_z;
      const Matrix2d theta_P = (radius / size_of_z) * (Matrix2d::Identity() - d * d.transpose());
      for (Index j = 0; j < num_held; ++j) {
        const Index column = held[static_cast<std::size_t>(j)];
        B_SE.block<2, 1>(s, j) = theta_P * W_->block<2, 1>(t, column);
        if (column == contact.normal) B_SE.block<2, 1>(s, j) -= scale * contact.friction * d;
      }
      for (Index j = 0; j < num_sliding; j += 2) {
        const Index column = sliding[static_cast<std::size_t>(j / 2)]->tangent();
        B_SS.block<2, 2>(s, j) = theta_P * W_->block<2, 2>(t, column);
      }
      B_SS.block<2, 2>(s, s) += scale * (Matrix2d::Identity() - theta_P);
      right_S.segment<2>(s) =
          -theta_P * (scale * force - (end.segment<2>(t) - delta_->segment<2>(t)));
    }
    B_SS.noalias() -= B_SE * right.leftCols(num_sliding);
    right_S.noalias() -= B_SE * forces_E;
    const VectorXd forces_S = B_SS.partialPivLu().solve(right_S);
    forces_E.noalias() -= right.leftCols(num_sliding) * forces_S;
    for (Index s = 0; s < num_sliding; s += 2) {
      target.segment<2>(sliding[static_cast<std::size_t>(s / 2)]->tangent()) =
          forces_S.segment<2>(s);
    }
  }
  for (Index i = 0; i < num_held; ++i) {
    target(held[static_cast<std::size_t>(i)]) = forces_E(i);
  }
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
  int rescue = kFirstRescue;
  int without_progress = 0;
  while (statistics.residual > parameters.tolerance &&
         statistics.iterations < parameters.max_iterations &&
         (without_progress < kPatience || best_residual > parameters.acceptable_residual)) {
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
      for (int sweep = 0; sweep < rescue; ++sweep) problem.Sweep(1.0, lambda, &end);
      rescue = std::min(2 * rescue, kLargestRescue);
      end = problem.End(*lambda);
      statistics.residual = problem.Residual(*lambda, end);
    }
    without_progress = statistics.residual < 0.9 * best_residual ? 0 : without_progress + 1;
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
  for (const ContactRows& contact : rows) covered += contact.size();
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
