#include "vacuum_gripper_sim/core/constraint_operator.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

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
                               double h) {
  world_ = &world;
  h_ = h;
  cup_.Reset(factorization, h);
  plain_column_.clear();
  columns_of_.clear();
  num_columns_ = 0;
  plain_ = true;
  num_rows_ = 0;
  rows_.clear();
  bodies_.clear();
  for (int body = 0; body < world.num_bodies(); ++body) {
    bodies_.push_back({world.CentreOfMass(body), world.Mass(body), world.Mass(body).inverse()});
  }
}

bool ConstraintOperator::MayBePlain(const Contact& contact) const {
  return contact.num_nodes == 1 && contact.friction == 0.0 && contact.object != RigidWorld::kNone &&
         world_->BodyOf(contact.object) == RigidWorld::kNone;
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
  AddColumns(contacts);
  plain_ = std::all_of(plain_column_.begin(), plain_column_.end(),
                       [](int column) { return column >= 0; });
  SetRows(contacts);
  if (!plain_) UpdateW();
}

void ConstraintOperator::AddColumns(const std::vector<Contact>& contacts) {
  new_columns_.clear();
  const auto next_column = [&] { return num_columns_ + static_cast<int>(new_columns_.size()); };
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    if (i >= plain_column_.size()) {
      plain_column_.push_back(MayBePlain(contact) ? next_column() : -1);
      if (MayBePlain(contact)) {
        new_columns_.push_back({system_->FreeRow(contact.nodes[0]) / 3, contact.normal});
      }
    }
    if (IsPlain(i)) continue;
    for (int k = 0; k < contact.num_nodes; ++k) {
      const int node = contact.nodes[static_cast<std::size_t>(k)];
      const int row = system_->FreeRow(node);
      if (row < 0 || !columns_of_.emplace(node, next_column()).second) continue;
      for (int axis = 0; axis < 3; ++axis) {
        new_columns_.push_back({row / 3, Eigen::Vector3d::Unit(axis)});
      }
    }
  }
  cup_.Append(new_columns_);
  num_columns_ += static_cast<int>(new_columns_.size());
}

void ConstraintOperator::SetRows(const std::vector<Contact>& contacts) {
  rows_.clear();
  num_rows_ = 0;
  rows_between_bodies_.clear();
  for (const Contact& contact : contacts) {
    rows_.push_back({num_rows_, contact.friction});
    const Index next = num_rows_ + rows_.back().size();
    for (; num_rows_ < next; ++num_rows_) {
      if (contact.num_nodes == 0) rows_between_bodies_.push_back(num_rows_);
    }
  }
  if (plain_) return;

  std::vector<Eigen::Triplet<double>> entries;
  J_.setZero(num_rows_, 6 * static_cast<Index>(bodies_.size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const Eigen::Matrix3d axes = Axes(contact);
    const Index first = rows_[i].normal;
    const Index num_axes = rows_[i].size();
    if (IsPlain(i)) {
      entries.emplace_back(static_cast<int>(first), plain_column_[i], 1.0);
      continue;
    }
    for (int k = 0; k < contact.num_nodes; ++k) {
      const auto place = columns_of_.find(contact.nodes[static_cast<std::size_t>(k)]);
      if (place == columns_of_.end()) continue;  // clamped
      const double weight = contact.weights[static_cast<std::size_t>(k)];
      for (Index axis = 0; axis < num_axes; ++axis) {
        for (int xyz = 0; xyz < 3; ++xyz) {
          entries.emplace_back(static_cast<int>(first + axis), place->second + xyz,
                               weight * axes(xyz, axis));
        }
      }
    }
    AddBodyEntries(contact, contact.object, -1.0, rows_[i]);
    AddBodyEntries(contact, contact.other, 1.0, rows_[i]);
  }
  H_.resize(num_rows_, num_columns_);
  H_.setFromTriplets(entries.begin(), entries.end());
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
  const Eigen::MatrixXd H_A_inverse = H_ * cup_.W();  // with its h^2
  W_ = H_A_inverse * H_.transpose();
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const auto J_b = J_.middleCols<6>(6 * static_cast<Index>(body));
    W_.noalias() += h_ * h_ * (J_b * bodies_[body].M_inverse).eval() * J_b.transpose();
  }
  for (const Index row : rows_between_bodies_) W_(row, row) *= 1.0 + kBodyCompliance;
}

VectorXd ConstraintOperator::BodyVelocities(const VectorXd& b) const {
  VectorXd dV(b.size());
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const auto first = 6 * static_cast<Index>(body);
    dV.segment<6>(first) = bodies_[body].M_inverse * b.segment<6>(first);
  }
  return dV;
}

VectorXd ConstraintOperator::BodyImpulses(const VectorXd& dV) const {
  VectorXd b(dV.size());
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const auto first = 6 * static_cast<Index>(body);
    b.segment<6>(first) = bodies_[body].M * dV.segment<6>(first);
  }
  return b;
}

VectorXd ConstraintOperator::GapChanges(const SystemVector& y) const {
  if (plain_) return cup_.GapChanges(y.cup);
  return H_ * cup_.GapChanges(y.cup) + h_ * J_ * y.bodies;
}

void ConstraintOperator::AddForces(const VectorXd& lambda, SystemVector* y) const {
  if (plain_) {
    cup_.AddForces(lambda, &y->cup);
    return;
  }
  cup_.AddForces(H_.transpose() * lambda, &y->cup);
  y->bodies += BodyVelocities(h_ * J_.transpose() * lambda);
}

void ConstraintOperator::AddImpulses(const VectorXd& lambda, SystemVector* b) const {
  if (plain_) {
    cup_.AddImpulses(lambda, &b->cup);
    return;
  }
  cup_.AddImpulses(H_.transpose() * lambda, &b->cup);
  b->bodies += h_ * J_.transpose() * lambda;
}

}  // namespace vacuum_gripper_sim
