#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace vacuum_gripper_sim {

/// Elements worked on side by side, a lane each: as many as fill a vector register, four at least.
constexpr int kPackLanes =
    std::max(4, EIGEN_MAX_STATIC_ALIGN_BYTES / static_cast<int>(sizeof(double)));
/// A quantity of each of them.
using Pack = Eigen::Array<double, kPackLanes, 1>;
using PackVector3 = std::array<Pack, 3>;
/// Entry (i, j) at i + 3 j.
using PackMatrix3 = std::array<Pack, 9>;

}  // namespace vacuum_gripper_sim
