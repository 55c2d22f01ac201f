#include "vacuum_gripper_sim/core/constraint_operator.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

/// A body that lies on another is held by more forces than it has ways to move. Contacts that give
/// way by this share of what the body does share its load; under its weight it sinks by h^2 g times
/// that.
constexpr double kBodyCompliance = 1e-7;
/// Sine of the angle below which a direction is not across a normal.
constexpr double kAcross = 0.1;

}  // namespace

using Eigen::Index;
using Eigen::VectorXd;

void ConstraintOperator::Reset(const SparseCholesky& factorization, const RigidWorld& world,
                               double h, std::vector<DelassusOperator>* prepared) {
  world_ = &world;
  h_ = h;
  columns_.Reset(factorization, world);
  pieces_.resize(columns_.num_pieces());
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    pieces_[p].compliance.Reset(factorization, h);
    if (prepared != nullptr) pieces_[p].compliance.Adopt(&(*prepared)[p]);
  }
  bodies_.clear();
  for (int body = 0; body < world.num_bodies(); ++body) {
    bodies_.push_back({world.CentreOfMass(body), world.Mass(body), world.Mass(body).inverse()});
  }
  rows_.clear();
  num_rows_ = 0;
}

Eigen::Matrix3d ConstraintOperator::Axes(const Contact& contact) {
  Eigen::Matrix3d axes;
  axes.col(0) = contact.normal;
  const Eigen::Vector3d t = contact.normal.cross(contact.across);
  // Past an edge the normal may have turned towards what was across it.
  axes.col(2) = t.norm() > kAcross ? t.normalized() : contact.normal.unitOrthogonal();
  axes.col(1) = axes.col(2).cross(contact.normal);
  return axes;
}

void ConstraintOperator::SetContacts(const std::vector<Contact>& contacts) {
  columns_.Extend(contacts);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    pieces_[p].compliance.SetRows(columns_.by_piece()[p]);
  }
  SetRows(contacts);
  if (!plain()) SetH(contacts);
  UpdateW();
}

/// Numbers the groups of W, those of pieces first, and finds that of each contact.
void ConstraintOperator::FindGroups(const std::vector<Contact>& contacts) {
  // For now a piece's group is the first piece of it.
  for (std::size_t p = 0; p < pieces_.size(); ++p) pieces_[p].group = p;
  const auto merge = [&](std::size_t a, std::size_t b) {
    for (Piece& piece : pieces_) {
      if (piece.group == std::max(a, b)) piece.group = std::min(a, b);
    }
  };
  constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
  groups_.assign(contacts.size(), kNowhere);  // for now a piece of each contact
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (int k = 0; k < contacts[i].num_nodes; ++k) {
      const int row = system_->FreeRow(contacts[i].nodes[static_cast<std::size_t>(k)]);
      if (row < 0) continue;
      const std::size_t piece = columns_.PieceOf(row);
      if (groups_[i] == kNowhere) groups_[i] = piece;
      merge(pieces_[groups_[i]].group, pieces_[piece].group);
    }
  }
  std::size_t num_groups = 0;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    pieces_[p].group = pieces_[p].group == p ? num_groups++ : pieces_[pieces_[p].group].group;
  }
  between_bodies_ = num_groups;
  for (std::size_t& group : groups_) {
    group = group == kNowhere ? num_groups++ : pieces_[group].group;
  }
  W_.groups.resize(num_groups);
}

void ConstraintOperator::SetRows(const std::vector<Contact>& contacts) {
  FindGroups(contacts);
  for (ContactCompliance::Group& group : W_.groups) group.first = 0;  // for now its rows so far
  rows_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    Index& next = W_.groups[groups_[i]].first;
    rows_.push_back({next, contacts[i].friction});
    next += rows_.back().size();
  }
  num_rows_ = 0;
  for (ContactCompliance::Group& group : W_.groups) {
    const Index size = std::exchange(group.first, num_rows_);
    group.C.resize(size, size);
    num_rows_ += size;
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) rows_[i].normal += W_.groups[groups_[i]].first;
}

void ConstraintOperator::SetH(const std::vector<Contact>& contacts) {
  J_.setZero(num_rows(), 6 * static_cast<Index>(bodies_.size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const auto add = [&](Index row, const ContactColumns::Column& column, int offset,
                         double value) {
      Piece& piece = pieces_[static_cast<std::size_t>(column.piece)];
      piece.entries.emplace_back(static_cast<int>(row - W_.groups[piece.group].first),
                                 column.index + offset, value);
    };
    const Index first = rows_[i].normal;
    if (IsPlain(i)) {
      add(first, columns_.Plain(i), 0, 1.0);
      continue;
    }
    const Eigen::Matrix3d axes = Axes(contact);
    for (int k = 0; k < contact.num_nodes; ++k) {
      const int row = system_->FreeRow(contact.nodes[static_cast<std::size_t>(k)]);
      if (row < 0) continue;
      const double weight = contact.weights[static_cast<std::size_t>(k)];
      for (Index axis = 0; axis < rows_[i].size(); ++axis) {
        for (int xyz = 0; xyz < 3; ++xyz) {
          add(first + axis, columns_.OfNode(row), xyz, weight * axes(xyz, axis));
        }
      }
    }
    AddBodyEntries(contact, contact.object, -1.0, rows_[i]);
    AddBodyEntries(contact, contact.other, 1.0, rows_[i]);
  }
  for (Piece& piece : pieces_) Compress(W_.groups[piece.group].size(), &piece);
}

/// Makes H of its entries; unlike setFromTriplets() without memory of its own.
void ConstraintOperator::Compress(Index num_rows, Piece* piece) {
  std::vector<Eigen::Triplet<double>>& entries = piece->entries;
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return std::pair(a.row(), a.col()) < std::pair(b.row(), b.col());
  });
  piece->H.resize(num_rows, piece->compliance.num_contacts());
  auto entry = entries.begin();
  for (Index row = 0; row < num_rows; ++row) {
    piece->H.startVec(row);
    for (; entry != entries.end() && entry->row() == row; ++entry) {
      piece->H.insertBack(row, entry->col()) = entry->value();
    }
  }
  piece->H.finalize();
  entries.clear();
}

void ConstraintOperator::AddBodyEntries(const Contact& contact, int object, double sign,
                                        const ContactRows& rows) {
  if (object == RigidWorld::kNone || world_->BodyOf(object) == RigidWorld::kNone) return;
  const int body = world_->BodyOf(object);
  const Eigen::Vector3d arm = contact.p_W - bodies_[static_cast<std::size_t>(body)].c_W;
  const Eigen::Matrix3d axes = Axes(contact);
  for (Index axis = 0; axis < rows.size(); ++axis) {
    const Eigen::Vector3d d = axes.col(axis);
    J_.block<1, 3>(rows.normal + axis, 6 * body) += sign * d.transpose();
    J_.block<1, 3>(rows.normal + axis, 6 * body + 3) += sign * arm.cross(d).transpose();
  }
}

void ConstraintOperator::UpdateW() {
  if (plain()) {
    W_.U.resize(num_rows(), 0);
    for (const Piece& piece : pieces_) W_.groups[piece.group].C = piece.compliance.W();
    return;
  }
  W_.U.resize(num_rows(), J_.cols());
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const auto first = 6 * static_cast<Index>(body);
    Eigen::Matrix<double, 6, 6> root = bodies_[body].M_inverse.llt().matrixL();
    root *= h_;
    W_.U.middleCols<6>(first).noalias() = J_.middleCols<6>(first) * root;
  }
  for (ContactCompliance::Group& group : W_.groups) group.C.setZero();
  for (const Piece& piece : pieces_) {
    auto H_A_inverse = piece.by_column.Shape(piece.H.rows(), piece.H.cols());  // with its h^2
    H_A_inverse.noalias() = piece.H * piece.compliance.W();
    W_.groups[piece.group].C.noalias() += H_A_inverse * piece.H.transpose();
  }
  for (std::size_t g = between_bodies_; g < W_.groups.size(); ++g) {
    ContactCompliance::Group& group = W_.groups[g];
    group.C.diagonal() =
        kBodyCompliance * W_.U.middleRows(group.first, group.size()).rowwise().squaredNorm();
  }
}

void ConstraintOperator::BodyVelocities(const VectorXd& b, VectorXd* dV) const {
  dV->resize(b.size());
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const auto first = 6 * static_cast<Index>(body);
    dV->segment<6>(first) = bodies_[body].M_inverse * b.segment<6>(first);
  }
}

void ConstraintOperator::BodyImpulses(const VectorXd& dV, VectorXd* b) const {
  b->resize(dV.size());
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const auto first = 6 * static_cast<Index>(body);
    b->segment<6>(first) = bodies_[body].M * dV.segment<6>(first);
  }
}

/// h J^T lambda of a body.
RigidWorld::Vector6d ConstraintOperator::ImpulseOn(std::size_t body, const VectorXd& lambda) const {
  return h_ * J_.middleCols<6>(6 * static_cast<Index>(body)).transpose() * lambda;
}

void ConstraintOperator::GapChanges(const SystemVector& y, VectorXd* changes) const {
  changes->setZero(num_rows());
  for (const Piece& piece : pieces_) {
    const ContactCompliance::Group& group = W_.groups[piece.group];
    auto of_group = changes->segment(group.first, group.size());
    if (plain()) {
      piece.compliance.GapChanges(y.cup, of_group);
    } else {
      auto by_column = piece.by_column.Shape(piece.H.cols());
      piece.compliance.GapChanges(y.cup, by_column);
      of_group.noalias() += piece.H * by_column;
    }
  }
  if (!plain()) changes->noalias() += h_ * J_ * y.bodies;
}

/// Calls f(compliance, forces) for every piece, with the forces along its columns.
template <typename Function>
void ConstraintOperator::ForEachPiece(const VectorXd& lambda, const Function& f) const {
  for (const Piece& piece : pieces_) {
    const ContactCompliance::Group& group = W_.groups[piece.group];
    const auto of_group = lambda.segment(group.first, group.size());
    if (plain()) {
      f(piece.compliance, of_group);
    } else {
      auto by_column = piece.by_column.Shape(piece.H.cols());
      by_column.noalias() = piece.H.transpose() * of_group;
      f(piece.compliance, by_column);
    }
  }
}

void ConstraintOperator::AddForces(const VectorXd& lambda, SystemVector* y) const {
  ForEachPiece(lambda, [&](const DelassusOperator& compliance, const auto& forces) {
    compliance.AddForces(forces, &y->cup);
  });
  for (std::size_t body = 0; body < bodies_.size() && !plain(); ++body) {
    y->bodies.segment<6>(6 * static_cast<Index>(body)) +=
        bodies_[body].M_inverse * ImpulseOn(body, lambda);
  }
}

void ConstraintOperator::AddImpulses(const VectorXd& lambda, SystemVector* b) const {
  ForEachPiece(lambda, [&](const DelassusOperator& compliance, const auto& forces) {
    compliance.AddImpulses(forces, &b->cup);
  });
  for (std::size_t body = 0; body < bodies_.size() && !plain(); ++body) {
    b->bodies.segment<6>(6 * static_cast<Index>(body)) += ImpulseOn(body, lambda);
  }
}

}  // namespace vacuum_gripper_sim
