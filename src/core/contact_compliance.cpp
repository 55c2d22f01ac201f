#include "vacuum_gripper_sim/core/contact_compliance.h"

#include <algorithm>

namespace vacuum_gripper_sim {

using Eigen::Index;

const ContactCompliance::Group& ContactCompliance::GroupOf(Index row) const {
  const auto ends_after = [](Index r, const Group& group) {
    return r < group.first + group.size();
  };
  return *std::upper_bound(groups.begin(), groups.end(), row, ends_after);
}

double ContactCompliance::Diagonal(Index row) const {
  const Group& group = GroupOf(row);
  const double own = group.C(row - group.first, row - group.first);
  return coupled() ? own + U.row(row).squaredNorm() : own;
}

Eigen::VectorXd ContactCompliance::Times(const Eigen::VectorXd& lambda) const {
  Eigen::VectorXd product(num_rows());
  for (const Group& group : groups) {
    product.segment(group.first, group.size()).noalias() =
        group.C * lambda.segment(group.first, group.size());
  }
  if (coupled()) product.noalias() += U * (U.transpose() * lambda).eval();
  return product;
}

}  // namespace vacuum_gripper_sim
