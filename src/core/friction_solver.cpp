#include "vacuum_gripper_sim/core/friction_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "vacuum_gripper_sim/core/linearized_contacts.h"

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

class FrictionProblem {
 public:
  FrictionProblem(const ContactCompliance& W, const VectorXd& delta,
                  const std::vector<ContactRows>& rows);

  /// Gaps and slips under the forces. [m]
  VectorXd End(const VectorXd& lambda) const { return *delta_ + W_->Times(lambda); }
  double Residual(const VectorXd& lambda, const VectorXd& end) const;
  void Sweep(double relaxation, VectorXd* lambda, VectorXd* end) const;
  VectorXd NewtonTarget(const VectorXd& lambda, const VectorXd& end) const;

 private:
  struct ScaledContact {
    ContactRows rows;
    const ContactCompliance::Group* group{nullptr};
    double normal_scale{0.0};   // W_nn [m/N]
    double tangent_scale{0.0};  // mean W_tt [m/N]
  };

  const ContactCompliance* W_;
  const VectorXd* delta_;
  std::vector<ScaledContact> contacts_;
};

FrictionProblem::FrictionProblem(const ContactCompliance& W, const VectorXd& delta,
                                 const std::vector<ContactRows>& rows)
    : W_(&W), delta_(&delta) {
  contacts_.reserve(rows.size());
  for (const ContactRows& contact : rows) {
    contacts_.push_back({contact, &W.GroupOf(contact.normal), W.Diagonal(contact.normal), 0.0});
    if (!contact.has_tangents()) continue;
    const Index t = contact.tangent();
    contacts_.back().tangent_scale = 0.5 * (W.Diagonal(t) + W.Diagonal(t + 1));
  }
}

double FrictionProblem::Residual(const VectorXd& lambda, const VectorXd& end) const {
  // A largest value would pass over what is no number.
  if (!lambda.allFinite() || !end.allFinite()) return std::numeric_limits<double>::infinity();
  double residual = 0.0;
  for (const ScaledContact& contact : contacts_) {
    const Index n = contact.rows.normal;
    residual = std::max(residual, std::abs(std::min(end(n), contact.normal_scale * lambda(n))));
    if (!contact.rows.has_tangents()) continue;
    const Index t = contact.rows.tangent();
    const double scale = contact.tangent_scale;
    const Vector2d force = lambda.segment<2>(t);
    const Vector2d projected = ProjectOntoDisc(force - end.segment<2>(t) / scale,
                                               contact.rows.friction * std::max(0.0, lambda(n)));
    residual = std::max(residual, scale * (force - projected).norm());
  }
  return residual;
}

/// One sweep of projected Gauss-Seidel. What the forces do through the bodies is added up on the
/// way, and to all rows at the end.
void FrictionProblem::Sweep(double relaxation, VectorXd* lambda, VectorXd* end) const {
  VectorXd moved = VectorXd::Zero(W_->U.cols());  // U^T (changes of lambda)
  for (const ScaledContact& contact : contacts_) {
    const Index first = contact.group->first;
    auto end_of_group = end->segment(first, contact.group->size());
    const Index n = contact.rows.normal;
    const double before = (*lambda)(n);
    const double gap = (*end)(n) + W_->U.row(n).dot(moved);
    (*lambda)(n) = std::max(0.0, before - relaxation * gap / contact.normal_scale);
    if (const double change = (*lambda)(n)-before; change != 0.0) {
      end_of_group.noalias() += change * contact.group->C.col(n - first);
      moved.noalias() += change * W_->U.row(n).transpose();
    }
    if (!contact.rows.has_tangents()) continue;
    const Index t = contact.rows.tangent();
    const Vector2d force = lambda->segment<2>(t);
    const Vector2d slip = end->segment<2>(t) + W_->U.middleRows<2>(t) * moved;
    lambda->segment<2>(t) = ProjectOntoDisc(force - relaxation * slip / contact.tangent_scale,
                                            contact.rows.friction * (*lambda)(n));
    const Vector2d change = lambda->segment<2>(t) - force;
    if (change.isZero(0.0)) continue;
    end_of_group.noalias() += contact.group->C.middleCols<2>(t - first) * change;
    moved.noalias() += W_->U.middleRows<2>(t).transpose() * change;
  }
  if (W_->coupled()) end->noalias() += W_->U * moved;
}

/// The forces to which a full Newton step leads: zero where contacts open, and of the closed ones
/// those of the linearised projections.
VectorXd FrictionProblem::NewtonTarget(const VectorXd& lambda, const VectorXd& end) const {
  std::vector<Index> held;
  std::vector<SlidingContact> sliding;
  for (const ScaledContact& contact : contacts_) {
    const Index n = contact.rows.normal;
    if (contact.normal_scale * lambda(n) - end(n) <= 0.0) continue;
    held.push_back(n);
    if (!contact.rows.has_tangents()) continue;
    const Index t = contact.rows.tangent();
    const double friction = contact.rows.friction;
    const Vector2d z = lambda.segment<2>(t) - end.segment<2>(t) / contact.tangent_scale;
    const double radius = friction * std::max(0.0, lambda(n));
    const double size_of_z = z.norm();
    if (size_of_z <= radius) {
      held.push_back(t);
      held.push_back(t + 1);
      continue;
    }
    const Vector2d d = z / size_of_z;
    const Matrix2d theta_P = (radius / size_of_z) * (Matrix2d::Identity() - d * d.transpose());
    sliding.push_back({n, t, friction, contact.tangent_scale, d, theta_P});
  }
  const LinearizedContacts contacts(*W_, held, sliding);
  return contacts.usable() ? contacts.Forces(*delta_) : lambda;
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

/// Contacts whose groups move each other, or of a single group.
McpStatistics SolveTogether(const ContactCompliance& W, const VectorXd& delta,
                            const std::vector<ContactRows>& rows,
                            const ContactParameters& parameters, VectorXd* lambda) {
  const FrictionProblem problem(W, delta, rows);
  McpStatistics statistics = parameters.method == ContactSolverMethod::kActiveSet
                                 ? Newton(problem, parameters, lambda)
                                 : GaussSeidel(problem, parameters, lambda);
  statistics.converged = statistics.residual <= parameters.tolerance;
  return statistics;
}

/// Contacts of a group that feels no other.
McpStatistics SolveAlone(const ContactCompliance::Group& group, const VectorXd& delta,
                         const std::vector<ContactRows>& rows, const ContactParameters& parameters,
                         VectorXd* lambda) {
  const auto is_within = [&](const ContactRows& contact) {
    return contact.normal >= group.first && contact.normal < group.first + group.size();
  };
  const bool has_friction = std::any_of(rows.begin(), rows.end(), [&](const ContactRows& contact) {
    return contact.has_tangents() && is_within(contact);
  });
  if (!has_friction) return SolveContacts(group.C, delta, parameters, lambda);
  std::vector<ContactRows> rows_within;  // counted from the group's first
  for (const ContactRows& contact : rows) {
    if (!is_within(contact)) continue;
    rows_within.push_back({contact.normal - group.first, contact.friction});
  }
  const ContactCompliance C{{{0, group.C}}, ContactCompliance::RowMajorMatrix(group.size(), 0)};
  return SolveTogether(C, delta, rows_within, parameters, lambda);
}

}  // namespace

McpStatistics SolveContactGroups(const ContactCompliance& W, const VectorXd& delta,
                                 const std::vector<ContactRows>& rows,
                                 const ContactParameters& parameters, VectorXd* lambda) {
  const Index size = delta.size();
  Index covered = 0;
  for (const ContactRows& contact : rows) covered += contact.size();
  if (W.num_rows() != size || lambda->size() != size || covered != size) {
    throw std::invalid_argument(
        "SolveContactGroups: W, delta, lambda and the contacts' rows must agree in size");
  }
  if (W.coupled()) return SolveTogether(W, delta, rows, parameters, lambda);
  if (W.groups.size() == 1) return SolveAlone(W.groups[0], delta, rows, parameters, lambda);
  McpStatistics statistics;
  for (const ContactCompliance::Group& group : W.groups) {
    VectorXd forces = lambda->segment(group.first, group.size());
    const McpStatistics of_group =
        SolveAlone(group, delta.segment(group.first, group.size()), rows, parameters, &forces);
    lambda->segment(group.first, group.size()) = forces;
    statistics.converged = statistics.converged && of_group.converged;
    statistics.iterations = std::max(statistics.iterations, of_group.iterations);
    statistics.residual = std::max(statistics.residual, of_group.residual);
  }
  return statistics;
}

}  // namespace vacuum_gripper_sim
