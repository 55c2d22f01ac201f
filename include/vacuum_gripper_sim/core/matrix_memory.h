#pragma once

#include <Eigen/Core>

namespace vacuum_gripper_sim {

/// Memory for matrices whose size changes from use to use: it grows, and is kept.
template <typename Scalar>
class MatrixMemory {
 public:
  using MatrixX = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using VectorX = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  /// A matrix of any values, there until the next one is asked for.
  template <typename Matrix = MatrixX>
  Eigen::Map<Matrix> Shape(Eigen::Index rows, Eigen::Index cols) {
    if (memory_.size() < rows * cols) memory_.resize(rows * cols);
    return {memory_.data(), rows, cols};
  }
  Eigen::Map<VectorX> Shape(Eigen::Index size) { return Shape<VectorX>(size, 1); }

 private:
  VectorX memory_;
};

}  // namespace vacuum_gripper_sim
