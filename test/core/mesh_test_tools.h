#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <initializer_list>
#include <stdexcept>
#include <string>

namespace vacuum_gripper_sim {

/// Expects std::invalid_argument with one line that has all the `parts`.
template <typename Function>
void ExpectInvalid(const Function& function, std::initializer_list<const char*> parts) {
  try {
    function();
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const char* part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << "no `" << part << "` in: " << message;
    }
    return;
  }
  ADD_FAILURE() << "nothing was thrown, expected `" << *parts.begin() << "`";
}

/// The corner of a cube of edge a: nodes 0, a e_x, a e_y, a e_z; volume a^3 / 6. [m]
inline Eigen::Matrix3Xd CubeCorner(const double a) {
  Eigen::Matrix3Xd nodes = Eigen::Matrix3Xd::Zero(3, 4);
  nodes.rightCols<3>() = a * Eigen::Matrix3d::Identity();
  return nodes;
}

/// Its 10-node form: the corners and the middles of the edges 01, 12, 20, 03, 13, 23. [m]
inline Eigen::Matrix3Xd QuadraticCubeCorner(const double a) {
  static constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  Eigen::Matrix3Xd nodes(3, 10);
  nodes.leftCols<4>() = CubeCorner(a);
  for (int k = 0; k < 6; ++k) {
    nodes.col(4 + k) = 0.5 * (nodes.col(kEdges[k][0]) + nodes.col(kEdges[k][1]));
  }
  return nodes;
}

}  // namespace vacuum_gripper_sim
