#pragma once

#include <Eigen/Core>
#include <vector>

namespace vacuum_gripper_sim {

/** W of contacts in groups, as those of several cups, that feel each other through free bodies
 alone:

     W = diag(C_1, C_2, ...) + U U^T,

 C_g being the compliance of what only group g touches, and U, of few columns, that of the bodies.
 Products and solutions so cost each cup the same, however many there are. */
struct ContactCompliance {
  struct Group {
    Eigen::Index first{0};  ///< Row of W; a group's rows stand together.
    Eigen::MatrixXd C;      ///< #rows square, symmetric. [m/N]

    Eigen::Index size() const { return C.rows(); }
  };
  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  std::vector<Group> groups;  ///< Their rows, ascending, cover W.
  RowMajorMatrix U;           ///< #rows by ways that bodies move, h J M^(-1/2). [(m/N)^(1/2)]

  Eigen::Index num_rows() const {
    return groups.empty() ? 0 : groups.back().first + groups.back().size();
  }
  /// Does a force of one group move what another one touches?
  bool coupled() const { return U.cols() > 0; }
  /// The group with this row.
  const Group& GroupOf(Eigen::Index row) const;
  /// W_ii. [m/N]
  double Diagonal(Eigen::Index row) const;
  /// gaps += factor W lambda. @param lambda [N] @param[in,out] gaps [m]
  void AddTimes(double factor, const Eigen::VectorXd& lambda, Eigen::VectorXd* gaps) const;
};

}  // namespace vacuum_gripper_sim
