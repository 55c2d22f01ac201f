#include "vacuum_gripper_sim/core/friction_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
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

}  // namespace

/// Gaps and slips under the forces, and from them the residual. @returns it. [m]
double FrictionSolver::FindEnd(const VectorXd& lambda) {
  end_ = *delta_;
  W_->AddTimes(1.0, lambda, &end_);
  return Residual(lambda);
}

double FrictionSolver::Residual(const VectorXd& lambda) const {
  // A largest value would pass over what is no number.
  if (!lambda.allFinite() || !end_.allFinite()) return std::numeric_limits<double>::infinity();
  double residual = 0.0;
  for (const ScaledContact& contact : contacts_) {
    const Index n = contact.rows.normal;
    residual = std::max(residual, std::abs(std::min(end_(n), contact.normal_scale * lambda(n))));
    if (!contact.rows.has_tangents()) continue;
    const Index t = contact.rows.tangent();
    const double scale = contact.tangent_scale;
    const Vector2d force = lambda.segment<2>(t);
    const Vector2d projected = ProjectOntoDisc(force - end_.segment<2>(t) / scale,
                                               contact.rows.friction * std::max(0.0, lambda(n)));
    residual = std::max(residual, scale * (force - projected).norm());
  }
  return residual;
}

/// One sweep of projected Gauss-Seidel. What the forces do through the bodies is added up on the
/// way, and to all rows at the end.
void FrictionSolver::Sweep(double relaxation, VectorXd* lambda) {
  const ContactCompliance::RowMajorMatrix& U = W_->U;
  moved_.setZero(U.cols());
  for (const ScaledContact& contact : contacts_) {
    const Index first = contact.group->first;
    auto end_of_group = end_.segment(first, contact.group->size());
    const Index n = contact.rows.normal;
    const double before = (*lambda)(n);
    const double gap = end_(n) + U.row(n).dot(moved_);
    (*lambda)(n) = std::max(0.0, before - relaxation * gap / contact.normal_scale);
    if (const double change = (*lambda)(n)-before; change != 0.0) {
      end_of_group.noalias() += change * contact.group->C.col(n - first);
      moved_.noalias() += change * U.row(n).transpose();
    }
    if (!contact.rows.has_tangents()) continue;
    const Index t = contact.rows.tangent();
    const Vector2d force = lambda->segment<2>(t);
    const Vector2d slip = end_.segment<2>(t) + U.middleRows<2>(t) * moved_;
    lambda->segment<2>(t) = ProjectOntoDisc(force - relaxation * slip / contact.tangent_scale,
                                            contact.rows.friction * (*lambda)(n));
    const Vector2d change = lambda->segment<2>(t) - force;
    if (change.isZero(0.0)) continue;
    end_of_group.noalias() += contact.group->C.middleCols<2>(t - first) * change;
    moved_.noalias() += U.middleRows<2>(t).transpose() * change;
  }
  if (W_->coupled()) end_.noalias() += U * moved_;
}

/// The forces to which a full Newton step leads: zero where contacts open, and of the closed ones
/// those of the linearised projections.
void FrictionSolver::FindNewtonTarget(const VectorXd& lambda) {
  held_.clear();
  sliding_.clear();
  for (const ScaledContact& contact : contacts_) {
    const Index n = contact.rows.normal;
    if (contact.normal_scale * lambda(n) - end_(n) <= 0.0) continue;
    held_.push_back(n);
    if (!contact.rows.has_tangents()) continue;
    const Index t = contact.rows.tangent();
    const double friction = contact.rows.friction;
    const Vector2d z = lambda.segment<2>(t) - end_.segment<2>(t) / contact.tangent_scale;
    const double radius = friction * std::max(0.0, lambda(n));
    const double size_of_z = z.norm();
    if (size_of_z <= radius) {
      held_.push_back(t);
      held_.push_back(t + 1);
      continue;
    }
    const Vector2d d = z / size_of_z;
    const Matrix2d theta_P = (radius / size_of_z) * (Matrix2d::Identity() - d * d.transpose());
    sliding_.push_back({n, t, friction, contact.tangent_scale, d, theta_P});
  }
  if (linearized_.Compute(*W_, held_, sliding_)) {
    linearized_.Forces(*delta_, &target_);
  } else {
    target_ = lambda;
  }
}

McpStatistics FrictionSolver::SolveByGaussSeidel(const ContactParameters& parameters,
                                                 VectorXd* lambda) {
  McpStatistics statistics;
  statistics.residual = FindEnd(*lambda);
  while (statistics.residual > parameters.tolerance &&
         statistics.iterations < parameters.max_iterations) {
    Sweep(parameters.relaxation, lambda);
    ++statistics.iterations;
    statistics.residual = Residual(*lambda);
  }
  return statistics;
}

McpStatistics FrictionSolver::SolveByNewton(const ContactParameters& parameters, VectorXd* lambda) {
  McpStatistics statistics;
  statistics.residual = FindEnd(*lambda);
  best_ = *lambda;
  double best_residual = statistics.residual;
  bool first = true;
  int rescue = kFirstRescue;
  int without_progress = 0;
  while (statistics.residual > parameters.tolerance &&
         statistics.iterations < parameters.max_iterations &&
         (without_progress < kPatience || best_residual > parameters.acceptable_residual)) {
    FindNewtonTarget(*lambda);
    ++statistics.iterations;
    start_ = *lambda;
    const double start_residual = statistics.residual;
    double share = 1.0;
    for (int halvings = 0; halvings <= kMaxHalvings; ++halvings, share *= 0.5) {
      *lambda = start_ + share * (target_ - start_);
      statistics.residual = FindEnd(*lambda);
      // The first full step may leave the warm start for another set of contacts.
      if (statistics.residual < start_residual || (first && std::isfinite(statistics.residual))) {
        break;
      }
    }
    first = false;
    if (!(statistics.residual < start_residual)) {
      if (!std::isfinite(statistics.residual)) *lambda = start_;
      FindEnd(*lambda);
      for (int sweep = 0; sweep < rescue; ++sweep) Sweep(1.0, lambda);
      rescue = std::min(2 * rescue, kLargestRescue);
      statistics.residual = FindEnd(*lambda);
    }
    without_progress = statistics.residual < 0.9 * best_residual ? 0 : without_progress + 1;
    if (statistics.residual < best_residual) {
      best_residual = statistics.residual;
      best_ = *lambda;
    }
  }
  *lambda = best_;
  statistics.residual = best_residual;
  return statistics;
}

/// Contacts whose groups move each other, or of a single group.
McpStatistics FrictionSolver::SolveTogether(const ContactCompliance& W, const VectorXd& delta,
                                            const std::vector<ContactRows>& rows,
                                            const ContactParameters& parameters, VectorXd* lambda) {
  W_ = &W;
  delta_ = &delta;
  contacts_.clear();
  for (const ContactRows& contact : rows) {
    contacts_.push_back({contact, &W.GroupOf(contact.normal), W.Diagonal(contact.normal), 0.0});
    if (!contact.has_tangents()) continue;
    const Index t = contact.tangent();
    contacts_.back().tangent_scale = 0.5 * (W.Diagonal(t) + W.Diagonal(t + 1));
  }
  McpStatistics statistics = parameters.method == ContactSolverMethod::kActiveSet
                                 ? SolveByNewton(parameters, lambda)
                                 : SolveByGaussSeidel(parameters, lambda);
  statistics.converged = statistics.residual <= parameters.tolerance;
  return statistics;
}

/// Contacts of a group that feels no other.
McpStatistics FrictionSolver::SolveAlone(const ContactCompliance& W, std::size_t group,
                                         const VectorXd& delta,
                                         const std::vector<ContactRows>& rows,
                                         const ContactParameters& parameters, VectorXd* lambda) {
  const ContactCompliance::Group& block = W.groups[group];
  rows_alone_.clear();  // counted from the group's first
  bool has_friction = false;
  for (const ContactRows& contact : rows) {
    if (contact.normal < block.first || contact.normal >= block.first + block.size()) continue;
    rows_alone_.push_back({contact.normal - block.first, contact.friction});
    has_friction = has_friction || contact.has_tangents();
  }
  delta_alone_ = delta.segment(block.first, block.size());
  lambda_alone_ = lambda->segment(block.first, block.size());
  McpStatistics statistics;
  if (has_friction) {
    alone_.groups.resize(1);
    alone_.groups[0].C = block.C;
    alone_.U.resize(block.size(), 0);
    statistics = SolveTogether(alone_, delta_alone_, rows_alone_, parameters, &lambda_alone_);
  } else {
    statistics = without_friction_.Solve(block.C, delta_alone_, parameters, &lambda_alone_);
  }
  lambda->segment(block.first, block.size()) = lambda_alone_;
  return statistics;
}

McpStatistics FrictionSolver::Solve(const ContactCompliance& W, const VectorXd& delta,
                                    const std::vector<ContactRows>& rows,
                                    const ContactParameters& parameters, VectorXd* lambda) {
  const Index size = delta.size();
  Index covered = 0;
  for (const ContactRows& contact : rows) covered += contact.size();
  if (W.num_rows() != size || lambda->size() != size || covered != size) {
    throw std::invalid_argument(
        "FrictionSolver: W, delta, lambda and the contacts' rows must agree in size");
  }
  if (W.coupled()) return SolveTogether(W, delta, rows, parameters, lambda);
  McpStatistics statistics;
  for (std::size_t group = 0; group < W.groups.size(); ++group) {
    const McpStatistics of_group = SolveAlone(W, group, delta, rows, parameters, lambda);
    statistics.converged = statistics.converged && of_group.converged;
    statistics.iterations = std::max(statistics.iterations, of_group.iterations);
    statistics.residual = std::max(statistics.residual, of_group.residual);
  }
  return statistics;
}

}  // namespace vacuum_gripper_sim
