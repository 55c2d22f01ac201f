#include "vacuum_gripper_sim/core/contact_factor.h"

#include <Eigen/Cholesky>
#include <cstddef>

namespace vacuum_gripper_sim {

using Eigen::Index;
using Eigen::MatrixXd;

bool ContactFactor::Compute(const MatrixXd& W, const std::vector<Index>& rows, Index first) {
  const auto size = static_cast<Index>(rows.size());
  if (L_.rows() < size) L_.resize(size, size);
  for (share_ = 1e-12; share_ < 1e-5; share_ *= 1e3) {
    auto lower = L_.topLeftCorner(size, size);
    for (Index j = 0; j < size; ++j) {
      const Index column = rows[static_cast<std::size_t>(j)] - first;
      for (Index i = j; i < size; ++i) {
        lower(i, j) = W(rows[static_cast<std::size_t>(i)] - first, column);
      }
      lower(j, j) *= 1.0 + share_;
    }
    const Eigen::LLT<Eigen::Ref<MatrixXd>> in_its_place(lower);
    if (in_its_place.info() == Eigen::Success) return true;
  }
  return false;
}

}  // namespace vacuum_gripper_sim
