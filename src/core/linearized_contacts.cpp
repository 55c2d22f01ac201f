#include "vacuum_gripper_sim/core/linearized_contacts.h"

#include <algorithm>
#include <cstddef>

namespace vacuum_gripper_sim {
namespace {

constexpr int kMaxRefinements = 3;
/// Share of the forces; smaller corrections are the last ones.
constexpr double kWorthRefining = 1e-8;

}  // namespace

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

bool LinearizedContacts::Compute(const ContactCompliance& W, const std::vector<Index>& held,
                                 const std::vector<SlidingContact>& sliding) {
  W_ = &W;
  groups_.resize(W.groups.size());
  const auto group_of = [&](Index row) -> Group& {
    return groups_[static_cast<std::size_t>(&W.GroupOf(row) - W.groups.data())];
  };
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].own = &W.groups[g];
    groups_[g].held.clear();
    groups_[g].sliding.clear();
  }
  for (const Index row : held) group_of(row).held.push_back(row);
  for (const SlidingContact& contact : sliding) group_of(contact.normal).sliding.push_back(contact);
  if (!std::all_of(groups_.begin(), groups_.end(), [](Group& group) { return Factorize(&group); }))
    return false;
  if (!W.coupled()) return true;
  inverse_QU_ = W.U;
  ApplyQ(&inverse_QU_);
  SolveGroups(&inverse_QU_);
  UT_inverse_QU_.noalias() = W.U.transpose() * inverse_QU_;
  UT_inverse_QU_.diagonal().array() += 1.0;
  capacitance_.compute(UT_inverse_QU_);
  return true;
}

bool LinearizedContacts::Factorize(Group* group) {
  const std::vector<Index>& held = group->held;
  const std::vector<SlidingContact>& sliding = group->sliding;
  const Index first = group->own->first;
  const MatrixXd& C = group->own->C;
  const auto num_held = static_cast<Index>(held.size());
  const auto num_sliding = 2 * static_cast<Index>(sliding.size());

  if (!group->C_EE.Compute(C, held, first)) return false;
  if (num_sliding == 0) return true;

  MatrixXd& C_ES = group->inverse_C_ES;
  MatrixXd& B_SE = group->B_SE;
  MatrixXd& B_SS = group->B_SS;
  C_ES.resize(num_held, num_sliding);
  B_SE.resize(num_sliding, num_held);
  B_SS.resize(num_sliding, num_sliding);
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
  group->C_EE.SolveInPlace(&C_ES);
  B_SS.noalias() -= B_SE * C_ES;
  group->complement.compute(B_SS);
  return true;
}

/// Leaves rows that are not in K as they are.
template <typename Matrix>
void LinearizedContacts::ApplyQ(Matrix* values) const {
  for (const Group& group : groups_) {
    for (const SlidingContact& contact : group.sliding) {
      for (Index column = 0; column < values->cols(); ++column) {
        const Vector2d z = values->col(column).template segment<2>(contact.tangent);
        values->col(column).template segment<2>(contact.tangent) = contact.theta_P * z;
      }
    }
  }
}

/// (S + Q C)^-1 of the columns; 0 in rows that are not in K.
template <typename Matrix>
void LinearizedContacts::SolveGroups(Matrix* values) {
  using ColumnMajor = Eigen::Matrix<double, Eigen::Dynamic, Matrix::ColsAtCompileTime>;
  for (const Group& group : groups_) {
    const auto num_held = static_cast<Index>(group.held.size());
    const auto num_sliding = 2 * static_cast<Index>(group.sliding.size());
    auto forces_E = forces_E_.Shape<ColumnMajor>(num_held, values->cols());
    auto right_S = right_S_.Shape<ColumnMajor>(num_sliding, values->cols());
    for (Index i = 0; i < num_held; ++i) {
      forces_E.row(i) = values->row(group.held[static_cast<std::size_t>(i)]);
    }
    for (Index s = 0; s < num_sliding; s += 2) {
      right_S.middleRows(s, 2) =
          values->middleRows(group.sliding[static_cast<std::size_t>(s / 2)].tangent, 2);
    }
    values->middleRows(group.own->first, group.own->size()).setZero();
    if (num_held == 0) continue;

    group.C_EE.SolveInPlace(&forces_E);
    if (num_sliding > 0) {
      right_S.noalias() -= group.B_SE * forces_E;
      auto forces_S = forces_S_.Shape<ColumnMajor>(num_sliding, values->cols());
      forces_S = group.complement.solve(right_S);
      forces_E.noalias() -= group.inverse_C_ES * forces_S;
      for (Index s = 0; s < num_sliding; s += 2) {
        values->middleRows(group.sliding[static_cast<std::size_t>(s / 2)].tangent, 2) =
            forces_S.middleRows(s, 2);
      }
    }
    for (Index i = 0; i < num_held; ++i) {
      values->row(group.held[static_cast<std::size_t>(i)]) = forces_E.row(i);
    }
  }
}

/// K^-1 of the values.
void LinearizedContacts::Solve(VectorXd* values) {
  SolveGroups(values);
  if (!W_->coupled()) return;
  UT_forces_.noalias() = W_->U.transpose() * *values;
  moved_ = capacitance_.solve(UT_forces_);
  values->noalias() -= inverse_QU_ * moved_;
}

/// right - K lambda, K with the larger diagonal; whatever in rows that are not in K. Without that,
/// refining would blow up forces that W does not determine.
void LinearizedContacts::FindResidual(const VectorXd& lambda) {
  residual_.setZero(lambda.size());
  W_->AddTimes(-1.0, lambda, &residual_);
  ApplyQ(&residual_);
  for (const Group& group : groups_) {
    for (const Index row : group.held) {
      const Index place = row - group.own->first;
      residual_(row) -= group.C_EE.share() * group.own->C(place, place) * lambda(row);
    }
    for (const SlidingContact& contact : group.sliding) {
      const Vector2d force = lambda.segment<2>(contact.tangent);
      residual_.segment<2>(contact.tangent) -=
          contact.scale *
          (force - contact.theta_P * force - contact.friction * lambda(contact.normal) * contact.d);
    }
  }
  residual_ += right_;
}

void LinearizedContacts::Forces(const VectorXd& delta, VectorXd* lambda) {
  right_ = -delta;
  ApplyQ(&right_);
  *lambda = right_;
  Solve(lambda);
  // Rows that only the bodies tell apart, as of a node between two of them, lose digits to the
  // nearly singular C; each time this finds some again.
  for (int i = 0; W_->coupled() && i < kMaxRefinements; ++i) {
    FindResidual(*lambda);
    VectorXd& correction = residual_;
    Solve(&correction);
    *lambda += correction;
    if (correction.norm() <= kWorthRefining * lambda->norm()) break;
  }
}

}  // namespace vacuum_gripper_sim
