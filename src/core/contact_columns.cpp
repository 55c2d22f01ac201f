#include "vacuum_gripper_sim/core/contact_columns.h"

namespace vacuum_gripper_sim {

void ContactColumns::Reset(const SparseCholesky& factorization, const RigidWorld& world) {
  factorization_ = &factorization;
  world_ = &world;
  by_piece_.resize(static_cast<std::size_t>(factorization.num_pieces()));
  for (std::vector<NodeColumn>& columns : by_piece_) columns.clear();
  plain_.clear();
  all_plain_ = true;
  of_node_.assign(static_cast<std::size_t>(system_->num_free()), Column());
}

bool ContactColumns::MayBePlain(const Contact& contact) const {
  return contact.num_nodes == 1 && contact.friction == 0.0 && contact.object != RigidWorld::kNone &&
         world_->BodyOf(contact.object) == RigidWorld::kNone;
}

ContactColumns::Column ContactColumns::Next(int free_row) const {
  const std::size_t piece = PieceOf(free_row);
  return {static_cast<int>(piece), static_cast<int>(by_piece_[piece].size())};
}

void ContactColumns::Extend(const std::vector<Contact>& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    if (i >= plain_.size()) {
      plain_.emplace_back();
      if (MayBePlain(contact)) {
        const int row = system_->FreeRow(contact.nodes[0]);
        plain_.back() = Next(row);
        by_piece_[PieceOf(row)].push_back({row / 3, contact.normal});
      }
    }
    if (IsPlain(i)) continue;
    all_plain_ = false;
    for (int k = 0; k < contact.num_nodes; ++k) {
      const int row = system_->FreeRow(contact.nodes[static_cast<std::size_t>(k)]);
      if (row < 0) continue;
      Column& first = of_node_[static_cast<std::size_t>(row / 3)];
      if (first.index >= 0) continue;
      first = Next(row);
      for (int axis = 0; axis < 3; ++axis) {
        by_piece_[PieceOf(row)].push_back({row / 3, Eigen::Vector3d::Unit(axis)});
      }
    }
  }
}

}  // namespace vacuum_gripper_sim
