#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vacuum_gripper_sim/core/elastic_body.h"
#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

/** The linear system of one implicit Euler step ([Bernardin, eq. (2)] with lambda = 0),

     A dv = b,  A = M + h D + h^2 K,  b = h (f(x) + f_ext - D v) - h^2 K v,
     D = alpha M + beta K,

 split into free nodes (index f) and clamped nodes (index c), whose dv is prescribed:

     A_ff dv_f = b_f - A_fc dv_c
     r_c = (A_cf dv_f + A_cc dv_c - b_c) / h    force that holds the clamped nodes        [N]

 A carries kg, b kg m/s. The sparsity is found once; Linearize() only refills the values. */
class ImplicitEuler {
 public:
  /// @param body Must outlive this. @param clamped_nodes Sorted, unique.
  ImplicitEuler(const ElasticBody& body, const std::vector<int>& clamped_nodes);

  /** Refills A and b.
   @param x,v Positions [m] and velocities [m/s], 3 by #nodes.
   @param h Time step. [s]
   @param gravity World frame. [m/s^2] */
  void Linearize(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double h,
                 const RayleighDamping& damping, const Eigen::Vector3d& gravity);

  int num_free() const { return static_cast<int>(free_nodes_.size()); }
  const std::vector<int>& free_nodes() const { return free_nodes_; }
  const std::vector<int>& clamped_nodes() const { return clamped_nodes_; }
  /// First of a node's three rows in the free system, or -1 if it is clamped.
  int FreeRow(int node) const { return free_row_[static_cast<std::size_t>(node)]; }

  /// A_ff, lower triangle. [kg]
  const Eigen::SparseMatrix<double>& A_ff() const { return A_ff_; }
  /// b_f - A_fc dv_c. @param dv_c 3 by #clamped. [m/s] @returns 3 #free. [kg m/s]
  Eigen::VectorXd FreeRightHandSide(const Eigen::Matrix3Xd& dv_c) const;
  /// r_c. @param dv_f 3 #free, @param dv_c 3 by #clamped. [m/s] @returns 3 by #clamped. [N]
  Eigen::Matrix3Xd ClampedReaction(const Eigen::VectorXd& dv_f, const Eigen::Matrix3Xd& dv_c) const;

  /// Values of a 3 by #nodes array at the free nodes, stacked.
  Eigen::VectorXd GatherFree(const Eigen::Matrix3Xd& values) const;
  /// 3 by #nodes array with the stacked values at the free nodes and `values_c` at the clamped
  /// ones.
  Eigen::Matrix3Xd Scatter(const Eigen::VectorXd& values_f, const Eigen::Matrix3Xd& values_c) const;

 private:
  /// Where one 3 by 3 block of an element's matrix goes: the offsets of its three columns.
  struct BlockTarget {
    enum class Matrix : std::uint8_t { kNone, kFreeLower, kFreeDiagonal, kClampedFree, kClamped };
    Matrix matrix{Matrix::kNone};
    std::array<int, 3> offsets{};
  };

  void FindSparsity();
  void MapBlocks();
  template <typename Element, typename Law>
  void AddElements(const std::vector<Element>& elements, const Law& law, const Eigen::Matrix3Xd& x,
                   const Eigen::Matrix3Xd& v, double h, double beta);
  template <typename Element>
  void AddBlocks(const typename Element::Stiffness& K_e, double factor, const BlockTarget* targets);
  void AddMasses(const Eigen::Matrix3Xd& v, double h, double alpha, const Eigen::Vector3d& gravity);

  const ElasticBody* body_;
  std::vector<int> free_nodes_;
  std::vector<int> clamped_nodes_;
  std::vector<int> free_row_;     // by node; -1: clamped
  std::vector<int> clamped_row_;  // by node; -1: free
  Eigen::SparseMatrix<double> A_ff_;
  Eigen::SparseMatrix<double> A_cf_;  // rows clamped, columns free
  Eigen::MatrixXd A_cc_;
  Eigen::Matrix3Xd b_;                // all nodes
  double h_{0.0};                     // of the last Linearize()
  std::vector<BlockTarget> targets_;  // element by element, blocks (a, b) row-major
  std::vector<int> mass_offsets_;     // of the diagonal of A_ff, a free row each
};

}  // namespace vacuum_gripper_sim
