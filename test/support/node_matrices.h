#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <map>
#include <utility>

#include "vacuum_gripper_sim/core/node_matrix.h"

namespace vacuum_gripper_sim {

/// @param lower Triangle of a symmetric matrix whose size is a multiple of three.
inline NodeMatrix MakeNodeMatrix(const Eigen::SparseMatrix<double>& lower) {
  NodeMatrix A;
  A.num_nodes = static_cast<int>(lower.cols()) / 3;
  std::map<std::pair<int, int>, std::size_t> place_of;
  for (int column = 0; column < lower.cols(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(lower, column); entry; ++entry) {
      const auto row = static_cast<int>(entry.row());
      const auto [place, is_new] =
          place_of.emplace(std::pair(row / 3, column / 3), A.places.size());
      if (is_new) {
        A.places.push_back({row / 3, column / 3});
        A.values.push_back(NodeBlock::Zero());
      }
      NodeBlock& block = A.values[place->second];
      block(row % 3, column % 3) = entry.value();
      if (row / 3 == column / 3) block(column % 3, row % 3) = entry.value();
    }
  }
  return A;
}

inline Eigen::MatrixXd Dense(const NodeMatrix& A) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * A.num_nodes, 3 * A.num_nodes);
  for (std::size_t i = 0; i < A.places.size(); ++i) {
    const auto& [row, column] = A.places[i];
    const Eigen::Matrix3d block = A.values[i].topRows<3>();
    dense.block<3, 3>(3 * row, 3 * column) += block;
    if (row != column) dense.block<3, 3>(3 * column, 3 * row) += block.transpose();
  }
  return dense;
}

}  // namespace vacuum_gripper_sim
