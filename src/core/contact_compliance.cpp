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

void ContactCompliance::AddTimes(double factor, const Eigen::VectorXd& lambda,
                                 Eigen::VectorXd* gaps) const {
  for (const Group& group : groups) {
    gaps->segment(group.first, group.size()).noalias() +=
        factor * group.C * lambda.segment(group.first, group.size());
  }
  for (Index way = 0; way < U.cols(); ++way) {
    gaps->noalias() += factor * U.col(way).dot(lambda) * U.col(way);
  }
}

}  // namespace vacuum_gripper_sim
