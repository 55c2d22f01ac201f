#include "vacuum_gripper_sim/core/implicit_euler.h"

#include <cmath>

namespace vacuum_gripper_sim {
namespace {

/// First row of each free node; -1: clamped.
std::vector<int> FreeRows(int num_nodes, const std::vector<int>& clamped_nodes) {
  std::vector<int> rows(static_cast<std::size_t>(num_nodes), 0);
  for (const int node : clamped_nodes) rows[static_cast<std::size_t>(node)] = -1;
  int next = 0;
  for (int& row : rows) {
    if (row < 0) continue;
    row = next;
    next += 3;
  }
  return rows;
}

}  // namespace

ImplicitEuler::ImplicitEuler(const ElasticBody& body, const std::vector<int>& clamped_nodes)
    : body_(&body),
      clamped_nodes_(clamped_nodes),
      free_row_(FreeRows(body.num_nodes(), clamped_nodes)),
      loops_(body, clamped_nodes),
      matrix_(body, free_row_),
      A_ff_(matrix_.pattern()) {
  for (int node = 0; node < body.num_nodes(); ++node) {
    if (FreeRow(node) >= 0) free_nodes_.push_back(node);
  }
  no_dv_f_.setZero(3 * num_free());
  no_dv_c_.setZero(3, static_cast<Eigen::Index>(clamped_nodes_.size()));
}

void ImplicitEuler::Linearize(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double h,
                              const RayleighDamping& damping, const Eigen::Vector3d& gravity,
                              Crew* crew) {
  h_ = h;
  assembled_ = false;
  linearization_.stiffness_factor = h * damping.stiffness + h * h;
  linearization_.mass_factor = 1.0 + h * damping.mass;
  loops_.Linearize(x, v, h, linearization_.stiffness_factor, &linearization_.tangents, &b_, crew);
  b_.noalias() += h * gravity * body_->weights().transpose();
  b_ -= v * (h * damping.mass * body_->masses()).asDiagonal();
}

/// product_ += c K dv_ at the clamped nodes, or of their motion alone.
void ImplicitEuler::AddStiffnessOfClamped() {
  loops_.AddStiffnessOfClamped(linearization_.tangents, linearization_.stiffness_factor, dv_,
                               &product_);
}

const NodeMatrix& ImplicitEuler::A_ff(Crew* crew) {
  if (!assembled_) matrix_.Assemble(linearization_, &A_ff_, crew);
  assembled_ = true;
  return A_ff_;
}

double ImplicitEuler::ImpulseScale() const {
  constexpr double kStandardGravity = 9.80665;  // m/s^2
  double squared = 0.0;
  for (const int node : free_nodes_) squared += body_->masses()(node) * body_->masses()(node);
  return h_ * kStandardGravity * std::sqrt(squared);
}

const Eigen::VectorXd& ImplicitEuler::Multiply(const Eigen::VectorXd& dv_f, Crew* crew) {
  Scatter(dv_f, no_dv_c_, &dv_);
  product_ = dv_ * (linearization_.mass_factor * body_->masses()).asDiagonal();
  loops_.AddStiffness(linearization_.tangents, linearization_.stiffness_factor, dv_, &product_,
                      crew);
  GatherFree(product_, &free_result_);
  return free_result_;
}

const Eigen::VectorXd& ImplicitEuler::FreeRightHandSide(const Eigen::Matrix3Xd& dv_c) {
  Scatter(no_dv_f_, dv_c, &dv_);
  product_.setZero(3, dv_.cols());
  AddStiffnessOfClamped();
  product_ = b_ - product_;
  GatherFree(product_, &free_result_);
  return free_result_;
}

const Eigen::Matrix3Xd& ImplicitEuler::ClampedReaction(const Eigen::VectorXd& dv_f,
                                                       const Eigen::Matrix3Xd& dv_c) {
  Scatter(dv_f, dv_c, &dv_);
  product_ = dv_ * (linearization_.mass_factor * body_->masses()).asDiagonal();
  AddStiffnessOfClamped();
  reaction_.resize(3, dv_c.cols());
  for (Eigen::Index i = 0; i < dv_c.cols(); ++i) {
    const int node = clamped_nodes_[static_cast<std::size_t>(i)];
    reaction_.col(i) = (product_.col(node) - b_.col(node)) / h_;
  }
  return reaction_;
}

void ImplicitEuler::GatherFree(const Eigen::Matrix3Xd& values, Eigen::VectorXd* gathered) const {
  gathered->resize(3 * num_free());
  for (int i = 0; i < num_free(); ++i) {
    gathered->segment<3>(3 * i) = values.col(free_nodes_[static_cast<std::size_t>(i)]);
  }
}

Eigen::VectorXd ImplicitEuler::GatherFree(const Eigen::Matrix3Xd& values) const {
  Eigen::VectorXd gathered;
  GatherFree(values, &gathered);
  return gathered;
}

void ImplicitEuler::Scatter(const Eigen::VectorXd& values_f, const Eigen::Matrix3Xd& values_c,
                            Eigen::Matrix3Xd* scattered) const {
  scattered->resize(3, body_->num_nodes());
  for (int i = 0; i < num_free(); ++i) {
    scattered->col(free_nodes_[static_cast<std::size_t>(i)]) = values_f.segment<3>(3 * i);
  }
  for (std::size_t i = 0; i < clamped_nodes_.size(); ++i) {
    scattered->col(clamped_nodes_[i]) = values_c.col(static_cast<Eigen::Index>(i));
  }
}

Eigen::Matrix3Xd ImplicitEuler::Scatter(const Eigen::VectorXd& values_f,
                                        const Eigen::Matrix3Xd& values_c) const {
  Eigen::Matrix3Xd scattered;
  Scatter(values_f, values_c, &scattered);
  return scattered;
}

}  // namespace vacuum_gripper_sim
