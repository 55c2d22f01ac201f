#include "vacuum_gripper_sim/core/linearized_contacts.h"

#include <algorithm>
#include <cstddef>

#include "vacuum_gripper_sim/core/mcp_solver.h"

namespace vacuum_gripper_sim {
namespace {

constexpr int kMaxRefinements = 3;
/// Share of the forces; smaller corrections are the last ones.
constexpr double kWorthRefining = 1e-8;

}  // namespace

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

LinearizedContacts::LinearizedContacts(const ContactCompliance& W, const std::vector<Index>& held,
                                       const std::vector<SlidingContact>& sliding)
    : W_(&W), groups_(W.groups.size()) {
  const auto group_of = [&](Index row) -> Group& {
    return groups_[static_cast<std::size_t>(&W.GroupOf(row) - W.groups.data())];
  };
  for (std::size_t g = 0; g < groups_.size(); ++g) groups_[g].own = &W.groups[g];
  for (const Index row : held) group_of(row).held.push_back(row);
  for (const SlidingContact& contact : sliding) group_of(contact.normal).sliding.push_back(contact);
  groups_.erase(std::remove_if(groups_.begin(), groups_.end(),
                               [](const Group& group) { return group.held.empty(); }),
                groups_.end());
  for (Group& group : groups_) usable_ = usable_ && Factorize(&group);
  if (!usable_ || !W.coupled()) return;
  inverse_QU_ = W.U;
  ApplyQ(&inverse_QU_);
  SolveGroups(&inverse_QU_);
  MatrixXd capacitance = W.U.transpose() * inverse_QU_;
  capacitance.diagonal().array() += 1.0;
  capacitance_.compute(capacitance);
}

bool LinearizedContacts::Factorize(Group* group) const {
  const std::vector<Index>& held = group->held;
  const std::vector<SlidingContact>& sliding = group->sliding;
  const Index first = group->own->first;
  const MatrixXd& C = group->own->C;
  const auto num_held = static_cast<Index>(held.size());
  const auto num_sliding = 2 * static_cast<Index>(sliding.size());

  MatrixXd C_EE(num_held, num_held);
  for (Index j = 0; j < num_held; ++j) {
    const Index column = held[static_cast<std::size_t>(j)] - first;
    for (Index i = j; i < num_held; ++i) {
      C_EE(i, j) = C(held[static_cast<std::size_t>(i)] - first, column);
    }
  }
  group->C_EE = FactorOfContacts(C_EE, &group->share);
  if (group->C_EE.info() != Eigen::Success) return false;
  if (num_sliding == 0) return true;

  MatrixXd C_ES(num_held, num_sliding), B_SE(num_sliding, num_held), B_SS(num_sliding, num_sliding);
  for (Index s = 0; s < num_sliding; s += 2) {
    const SlidingContact& contact = sliding[static_cast<std::size_t>(s / 2)];
    const Index t = contact.tangent - first;
    for (Index i = 0; i < num_held; ++i) {
      const Index row = held[static_cast<std::size_t>(i)];
      const auto C_it = C.block<2, 1>(t, row - first);  // its transpose
      C_ES.block<1, 2>(i, s) = C_it.transpose();
      B_SE.block<2, 1>(s, i) = contact.theta_P * C_it;
      if (row == contact.normal) {
        B_SE.block<2, 1>(s, i) -= contact.scale * contact.friction * contact.d;
      }
    }
    for (Index j = 0; j < num_sliding; j += 2) {
      const Index column = sliding[static_cast<std::size_t>(j / 2)].tangent - first;
      B_SS.block<2, 2>(s, j) = contact.theta_P * C.block<2, 2>(t, column);
    }
    B_SS.block<2, 2>(s, s) += contact.scale * (Matrix2d::Identity() - contact.theta_P);
  }
  group->inverse_C_ES = group->C_EE.solve(C_ES);
  B_SS.noalias() -= B_SE * group->inverse_C_ES;
  group->complement.compute(B_SS);
  group->B_SE = std::move(B_SE);
  return true;
}

/// Leaves rows that are not in K as they are.
template <typename Matrix>
void LinearizedContacts::ApplyQ(Matrix* values) const {
  for (const Group& group : groups_) {
    for (const SlidingContact& contact : group.sliding) {
      auto rows = values->template middleRows<2>(contact.tangent);
      rows = (contact.theta_P * rows).eval();
    }
  }
}

/// (S + Q C)^-1 of the columns; 0 in rows that are not in K.
template <typename Matrix>
void LinearizedContacts::SolveGroups(Matrix* values) const {
  using ColumnMajor = Eigen::Matrix<double, Eigen::Dynamic, Matrix::ColsAtCompileTime>;
  const Matrix right = *values;
  values->setZero();
  for (const Group& group : groups_) {
    ColumnMajor forces_E(static_cast<Index>(group.held.size()), right.cols());
    for (Index i = 0; i < forces_E.rows(); ++i) {
      forces_E.row(i) = right.row(group.held[static_cast<std::size_t>(i)]);
    }
    group.C_EE.solveInPlace(forces_E);
    if (!group.sliding.empty()) {
      ColumnMajor right_S = -group.B_SE * forces_E;
      for (Index s = 0; s < right_S.rows(); s += 2) {
        right_S.middleRows(s, 2) +=
            right.middleRows(group.sliding[static_cast<std::size_t>(s / 2)].tangent, 2);
      }
      const ColumnMajor forces_S = group.complement.solve(right_S);
      forces_E.noalias() -= group.inverse_C_ES * forces_S;
      for (Index s = 0; s < forces_S.rows(); s += 2) {
        values->middleRows(group.sliding[static_cast<std::size_t>(s / 2)].tangent, 2) =
            forces_S.middleRows(s, 2);
      }
    }
    for (Index i = 0; i < forces_E.rows(); ++i) {
      values->row(group.held[static_cast<std::size_t>(i)]) = forces_E.row(i);
    }
  }
}

/// K^-1 right.
VectorXd LinearizedContacts::Solve(VectorXd right) const {
  SolveGroups(&right);
  if (W_->coupled()) {
    const VectorXd moved = capacitance_.solve(W_->U.transpose() * right);
    right.noalias() -= inverse_QU_ * moved;
  }
  return right;
}

/// right - K lambda, K with the larger diagonal; whatever in rows that are not in K. Without that,
/// refining would blow up forces that W does not determine.
VectorXd LinearizedContacts::Residual(const VectorXd& right, const VectorXd& lambda) const {
  VectorXd product = W_->Times(lambda);
  ApplyQ(&product);
  for (const Group& group : groups_) {
    for (const Index row : group.held) {
      const Index place = row - group.own->first;
      product(row) += group.share * group.own->C(place, place) * lambda(row);
    }
    for (const SlidingContact& contact : group.sliding) {
      const Eigen::Vector2d force = lambda.segment<2>(contact.tangent);
      product.segment<2>(contact.tangent) +=
          contact.scale *
          (force - contact.theta_P * force - contact.friction * lambda(contact.normal) * contact.d);
    }
  }
  return right - product;
}

VectorXd LinearizedContacts::Forces(const VectorXd& delta) const {
  VectorXd right = -delta;
  ApplyQ(&right);
  VectorXd lambda = Solve(right);
  // Rows that only the bodies tell apart, as of a node between two of them, lose digits to the
  // nearly singular C; each time this finds some again.
  for (int i = 0; W_->coupled() && i < kMaxRefinements; ++i) {
    const VectorXd correction = Solve(Residual(right, lambda));
    lambda += correction;
    if (correction.norm() <= kWorthRefining * lambda.norm()) break;
  }
  return lambda;
}

}  // namespace vacuum_gripper_sim
