#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/contact_columns.h"
#include "vacuum_gripper_sim/core/contact_compliance.h"
#include "vacuum_gripper_sim/core/contact_finder.h"
#include "vacuum_gripper_sim/core/delassus_operator.h"
#include "vacuum_gripper_sim/core/friction_solver.h"
#include "vacuum_gripper_sim/core/implicit_euler.h"
#include "vacuum_gripper_sim/core/matrix_memory.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"
#include "vacuum_gripper_sim/core/system_vector.h"

namespace vacuum_gripper_sim {

/** Rows of H for contacts of cups and free bodies, and W over both:

     W = h^2 (H A^-1 H^T + J M^-1 J^T),

 H acting on the cups' free nodes, J on the bodies' velocities. A contact has a row for its normal
 n and, with friction, two for tangents t1, t2 across it.

 Where A is in pieces, as that of several cups, so is A^-1: contacts of different pieces meet in the
 bodies alone. The rows stand piece by piece, those of pieces that touch together, and then those
 of each contact between bodies.

 Products share working memory: one thread at a time. */
class ConstraintOperator {
 public:
  explicit ConstraintOperator(const ImplicitEuler& system) : system_(&system), columns_(system) {}

  /// Forgets all contacts; SetContacts() is to follow, be it with none. @param factorization Of A.
  /// @param world Its bodies' masses hold from now on. Both must outlive this. @param h Time step.
  /// [s] @param prepared What another thread has made of that factorisation, by piece, for contacts
  /// that are most likely the first to come; they need no more work then. Exchanged for something
  /// else.
  void Reset(const SparseCholesky& factorization, const RigidWorld& world, double h,
             std::vector<DelassusOperator>* prepared = nullptr);

  /** Sets the rows. Columns of contacts that were there before, in the same places, stay. */
  void SetContacts(const std::vector<Contact>& contacts);
  /// Is contact `i` bound to the normal it came with, until Reset()?
  bool IsPlain(std::size_t i) const { return columns_.IsPlain(i); }

  /// Rows of each contact.
  const std::vector<ContactRows>& rows() const { return rows_; }
  Eigen::Index num_rows() const { return num_rows_; }
  /// n, or n, t1, t2 of a contact, a column each, world axes.
  static Eigen::Matrix3d Axes(const Contact& contact);
  /// [m/N]
  const ContactCompliance& W() const { return W_; }
  /// Are all contacts single normals of nodes on what does not move?
  bool plain() const { return columns_.all_plain(); }

  /// dV = M^-1 b of the bodies. @param b 6 #bodies. [N s], [N m s]
  void BodyVelocities(const Eigen::VectorXd& b, Eigen::VectorXd* dV) const;
  /// b = M dV of the bodies. @param dV 6 #bodies.
  void BodyImpulses(const Eigen::VectorXd& dV, Eigen::VectorXd* b) const;
  /// What an impulse does to gaps and slips. @param y L^-1 P b of the cup's, and M^-1 b of the
  /// bodies'. @param[out] changes [m]
  void GapChanges(const SystemVector& y, Eigen::VectorXd* changes) const;
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
  /// What is known of a piece of A.
  struct Piece {
    DelassusOperator compliance;  // of its columns
    std::size_t group{0};         // of W's
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::SparseMatrix<double, Eigen::RowMajor> H;  // #rows of its group by #columns
    mutable MatrixMemory<double> by_column;          // of products
  };
  void SetRows(const std::vector<Contact>& contacts);
  void FindGroups(const std::vector<Contact>& contacts);
  void SetH(const std::vector<Contact>& contacts);
  void AddBodyEntries(const Contact& contact, int object, double sign, const ContactRows& rows);
  static void Compress(Eigen::Index num_rows, Piece* piece);
  void UpdateW();
  template <typename Function>
  void ForEachPiece(const Eigen::VectorXd& lambda, const Function& f) const;
  RigidWorld::Vector6d ImpulseOn(std::size_t body, const Eigen::VectorXd& lambda) const;

  const ImplicitEuler* system_;
  const RigidWorld* world_{nullptr};
  double h_{0.0};
  std::vector<Body> bodies_;
  std::vector<Piece> pieces_;
  ContactColumns columns_;

  std::vector<ContactRows> rows_;
  std::vector<std::size_t> groups_;  // of W's, by contact
  Eigen::Index num_rows_{0};
  Eigen::MatrixXd J_;  // #rows by 6 #bodies
  ContactCompliance W_;
  std::size_t between_bodies_{0};  // first of W's groups without a piece
};

}  // namespace vacuum_gripper_sim
