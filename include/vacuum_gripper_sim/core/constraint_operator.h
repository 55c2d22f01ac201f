#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <map>
#include <vector>

#include "vacuum_gripper_sim/core/contact_finder.h"
#include "vacuum_gripper_sim/core/delassus_operator.h"
#include "vacuum_gripper_sim/core/friction_solver.h"
#include "vacuum_gripper_sim/core/implicit_euler.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"
#include "vacuum_gripper_sim/core/system_vector.h"

namespace vacuum_gripper_sim {

/** Rows of H for contacts of cup and free bodies, and W over both:

     W = h^2 (H A^-1 H^T + J M^-1 J^T),

 H acting on the cup's free nodes, J on the bodies' velocities. A contact has a row for its normal
 n and, with friction, two for tangents t1, t2 across it.

 A contact of one node with a frictionless surface that does not give way needs a single column of
 A^-1 H^T, along its normal. Others take three, along the world's axes, for each of their nodes:
 their directions may then turn, and nodes be shared, without new columns. */
class ConstraintOperator {
 public:
  explicit ConstraintOperator(const ImplicitEuler& system) : system_(&system) {}

  /// Forgets all contacts. @param factorization Of A. @param world Its bodies' masses hold from
  /// now on. Both must outlive this. @param h Time step. [s]
  void Reset(const SparseCholesky& factorization, const RigidWorld& world, double h);

  /** Sets the rows. Columns of contacts that were there before, in the same places, stay. */
  void SetContacts(const std::vector<Contact>& contacts);
  /// Is contact `i` bound to the normal it came with, until Reset()?
  bool IsPlain(std::size_t i) const { return plain_column_[i] >= 0; }

  /// Rows of each contact.
  const std::vector<ContactRows>& rows() const { return rows_; }
  Eigen::Index num_rows() const { return num_rows_; }
  /// n, or n, t1, t2 of a contact, a column each, world axes.
  static Eigen::Matrix3d Axes(const Contact& contact);
  /// [m/N]
  const Eigen::MatrixXd& W() const { return plain_ ? cup_.W() : W_; }
  /// Are all contacts single normals of nodes on what does not move?
  bool plain() const { return plain_; }

  /// M^-1 b of the bodies. @param b 6 #bodies. [N s], [N m s]
  Eigen::VectorXd BodyVelocities(const Eigen::VectorXd& b) const;
  /// M dV of the bodies. @param dV 6 #bodies.
  Eigen::VectorXd BodyImpulses(const Eigen::VectorXd& dV) const;
  /// What an impulse does to gaps and slips. [m] @param y L^-1 P b of the cup's, and M^-1 b of the
  /// bodies'.
  Eigen::VectorXd GapChanges(const SystemVector& y) const;
  /// Adds what the forces do. @param lambda [N] @param[in,out] y As in GapChanges().
  void AddForces(const Eigen::VectorXd& lambda, SystemVector* y) const;
  /// Adds their impulses. @param lambda [N] @param[in,out] b
  void AddImpulses(const Eigen::VectorXd& lambda, SystemVector* b) const;

 private:
  struct Body {
    Eigen::Vector3d c_W;
    Eigen::Matrix<double, 6, 6> M;
    Eigen::Matrix<double, 6, 6> M_inverse;
  };
  bool MayBePlain(const Contact& contact) const;
  void AddColumns(const std::vector<Contact>& contacts);
  void SetRows(const std::vector<Contact>& contacts);
  void AddBodyEntries(const Contact& contact, int object, double sign, const ContactRows& rows);
  void UpdateW();

  const ImplicitEuler* system_;
  const RigidWorld* world_{nullptr};
  double h_{0.0};
  std::vector<Body> bodies_;
  DelassusOperator cup_;           // of the columns
  std::vector<int> plain_column_;  // by contact; -1: takes those of its nodes
  std::map<int, int> columns_of_;  // a node's first of three columns
  std::vector<NodeColumn> new_columns_;
  int num_columns_{0};

  bool plain_{true};
  Eigen::Index num_rows_{0};
  std::vector<ContactRows> rows_;
  std::vector<Eigen::Index> rows_between_bodies_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> H_;  // #rows by #columns
  Eigen::MatrixXd J_;                               // #rows by 6 #bodies
  Eigen::MatrixXd W_;
};

}  // namespace vacuum_gripper_sim
