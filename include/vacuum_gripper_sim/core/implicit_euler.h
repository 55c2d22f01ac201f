#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/elastic_body.h"
#include "vacuum_gripper_sim/core/element_loops.h"
#include "vacuum_gripper_sim/core/node_matrix.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/step_matrix.h"

namespace vacuum_gripper_sim {

/** The linear system of one implicit Euler step ([Bernardin, eq. (2)] with lambda = 0),

     A dv = b,  A = M + h D + h^2 K,  b = h (f(x) + f_ext - D v) - h^2 K v,
     D = alpha M + beta K,

 split into free nodes (index f) and clamped nodes (index c), whose dv is prescribed:

     A_ff dv_f = b_f - A_fc dv_c
     r_c = (A_cf dv_f + A_cc dv_c - b_c) / h    force that holds the clamped nodes        [N]

 A carries kg, b kg m/s. Products with A go element by element; it is assembled when somebody asks
 for it, as to factorise it. */
class ImplicitEuler {
 public:
  /// @param body Must outlive this. @param clamped_nodes Sorted, unique.
  ImplicitEuler(const ElasticBody& body, const std::vector<int>& clamped_nodes);

  /** Finds b and what A is made of.
   @param x,v Positions [m] and velocities [m/s], 3 by #nodes.
   @param h Time step. [s]
   @param gravity World frame. [m/s^2]
   @param crew Shares the work; none: the calling thread alone. */
  void Linearize(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double h,
                 const RayleighDamping& damping, const Eigen::Vector3d& gravity,
                 Crew* crew = nullptr);

  int num_free() const { return static_cast<int>(free_nodes_.size()); }
  const std::vector<int>& free_nodes() const { return free_nodes_; }
  const std::vector<int>& clamped_nodes() const { return clamped_nodes_; }
  /// First of a node's three rows in the free system, or -1 if it is clamped.
  int FreeRow(int node) const { return free_row_[static_cast<std::size_t>(node)]; }

  /// Of the last Linearize(). [s]
  double time_step() const { return h_; }
  /// What A_ff is made of, and how; for another thread.
  const Linearization& linearization() const { return linearization_; }
  const StepMatrix& matrix() const { return matrix_; }
  /// A_ff, assembled if that has not been done since Linearize(). [kg]
  /// @param crew Shares that work; none: the calling thread alone.
  const NodeMatrix& A_ff(Crew* crew = nullptr);
  /// Of the step's impulses, however little the body moves: norm of the free nodes' masses times h
  /// and standard gravity. [kg m/s]
  double ImpulseScale() const;
  // What these return is valid until the next call of any of them.
  /// A_ff dv_f. @param dv_f 3 #free. [m/s] @param crew Shares the work, if any.
  /// @returns 3 #free. [kg m/s]
  const Eigen::VectorXd& Multiply(const Eigen::VectorXd& dv_f, Crew* crew = nullptr);
  /// b_f - A_fc dv_c. @param dv_c 3 by #clamped. [m/s] @returns 3 #free. [kg m/s]
  const Eigen::VectorXd& FreeRightHandSide(const Eigen::Matrix3Xd& dv_c);
  /// r_c. @param dv_f 3 #free, @param dv_c 3 by #clamped. [m/s] @returns 3 by #clamped. [N]
  const Eigen::Matrix3Xd& ClampedReaction(const Eigen::VectorXd& dv_f,
                                          const Eigen::Matrix3Xd& dv_c);

  /// Values of a 3 by #nodes array at the free nodes, stacked.
  void GatherFree(const Eigen::Matrix3Xd& values, Eigen::VectorXd* gathered) const;
  Eigen::VectorXd GatherFree(const Eigen::Matrix3Xd& values) const;
  /// 3 by #nodes array with the stacked values at the free nodes and `values_c` at the clamped
  /// ones.
  void Scatter(const Eigen::VectorXd& values_f, const Eigen::Matrix3Xd& values_c,
               Eigen::Matrix3Xd* scattered) const;
  Eigen::Matrix3Xd Scatter(const Eigen::VectorXd& values_f, const Eigen::Matrix3Xd& values_c) const;

 private:
  void AddStiffnessOfClamped();

  const ElasticBody* body_;
  std::vector<int> free_nodes_;
  std::vector<int> clamped_nodes_;
  std::vector<int> free_row_;  // by node; -1: clamped
  ElementLoops loops_;
  StepMatrix matrix_;

  // Of the last Linearize().
  double h_{0.0};
  Linearization linearization_;
  Eigen::Matrix3Xd b_;  // all nodes
  bool assembled_{false};
  NodeMatrix A_ff_;

  // Of a product with A, and its result.
  Eigen::Matrix3Xd dv_, product_;
  Eigen::VectorXd free_result_;
  Eigen::Matrix3Xd reaction_;
  Eigen::VectorXd no_dv_f_;
  Eigen::Matrix3Xd no_dv_c_;
};

}  // namespace vacuum_gripper_sim
