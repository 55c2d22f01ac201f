#pragma once

#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/contact_finder.h"
#include "vacuum_gripper_sim/core/eliminated_columns.h"
#include "vacuum_gripper_sim/core/implicit_euler.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"

namespace vacuum_gripper_sim {

/** The columns of A^-1 H^T that contacts take, piece by piece of A.

 A contact of one node with a frictionless surface that does not give way is plain: it takes a
 single column, along its normal. Others take three, along the world's axes, for each of their
 nodes: their directions may then turn, and nodes be shared, without new columns. */
class ContactColumns {
 public:
  struct Column {
    int piece{0};
    int index{-1};  ///< In its piece; -1: none.
  };

  explicit ContactColumns(const ImplicitEuler& system) : system_(&system) {}

  /// Forgets all. @param factorization Of A; its structure alone. @param world Says what gives way.
  /// Both must outlive this.
  void Reset(const SparseCholesky& factorization, const RigidWorld& world);
  /// Gives columns to contacts that have none. @param contacts Those so far, in the same places,
  /// and any more.
  void Extend(const std::vector<Contact>& contacts);

  /// In B of EliminateColumns(), by piece, in the order in which contacts came.
  const std::vector<std::vector<NodeColumn>>& by_piece() const { return by_piece_; }
  std::size_t num_pieces() const { return by_piece_.size(); }
  std::size_t PieceOf(int free_row) const {
    return static_cast<std::size_t>(factorization_->PieceOf(free_row / 3));
  }
  /// Is contact `i` bound to the normal it came with, until Reset()?
  bool IsPlain(std::size_t i) const { return plain_[i].index >= 0; }
  /// Are all?
  bool all_plain() const { return all_plain_; }
  /// The column of a plain contact.
  const Column& Plain(std::size_t i) const { return plain_[i]; }
  /// The first of a free node's three, for contacts that are not plain.
  const Column& OfNode(int free_row) const {
    return of_node_[static_cast<std::size_t>(free_row / 3)];
  }

 private:
  bool MayBePlain(const Contact& contact) const;
  Column Next(int free_row) const;

  const ImplicitEuler* system_;
  const SparseCholesky* factorization_{nullptr};
  const RigidWorld* world_{nullptr};
  std::vector<std::vector<NodeColumn>> by_piece_;
  std::vector<Column> plain_;  // by contact
  bool all_plain_{true};
  std::vector<Column> of_node_;
};

}  // namespace vacuum_gripper_sim
