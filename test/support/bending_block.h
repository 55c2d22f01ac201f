#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <utility>
#include <vector>

#include "support/block_mesh.h"
#include "support/node_matrices.h"
#include "vacuum_gripper_sim/core/constraint_operator.h"
#include "vacuum_gripper_sim/core/contact.h"
#include "vacuum_gripper_sim/core/elastic_body.h"
#include "vacuum_gripper_sim/core/implicit_euler.h"
#include "vacuum_gripper_sim/core/linear_solver.h"
#include "vacuum_gripper_sim/core/rigid_surface.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// The matrices of a block that bends on from step to step.
class BendingBlock {
 public:
  static constexpr double kTimeStep = 0.01;  // s

  explicit BendingBlock(TetMesh mesh = MakeBlock(4, 3, 2, {0.02, 0.01, 0.01}, false))
      : mesh_(std::move(mesh)) {}
  ImplicitEuler* system() { return &system_; }
  Eigen::Index size() const { return 3 * system_.num_free(); }
  const NodeMatrix& A() { return system_.A_ff(); }
  Eigen::MatrixXd Dense() { return vacuum_gripper_sim::Dense(A()); }
  void Bend(double slope) {
    x_.row(2) += slope * x_.row(0);
    Linearize();
  }
  void Turn(double angle) {
    x_ = (Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix() * x_).eval();
    Linearize();
  }
  void Linearize() {
    system_.Linearize(x_, Eigen::Matrix3Xd::Zero(3, x_.cols()), kTimeStep, {0.0, 2e-3},
                      Eigen::Vector3d::Zero());
  }

 private:
  const TetMesh mesh_;
  const ElasticBody body_{mesh_, {338000.0, 0.45, 1080.0}};
  ImplicitEuler system_{body_, mesh_.mount_nodes};
  Eigen::Matrix3Xd x_ = mesh_.nodes;
};

inline LinearSolverParameters SolverParametersWith(LinearSolverMethod method,
                                                   int refactor_interval = 3,
                                                   int max_iterations = 50) {
  LinearSolverParameters parameters;
  parameters.method = method;
  parameters.precision = Precision::kDouble;
  parameters.tolerance = 1e-10;
  parameters.position_tolerance = 0.0;  // the residual alone
  parameters.max_iterations = max_iterations;
  parameters.refactor_interval = refactor_interval;
  return parameters;
}

/// Frictionless contacts of nodes of the free system with a plane that does not move.
class Touching {
 public:
  Touching(const ImplicitEuler& system, const LinearSolver& solver,
           const std::vector<NodeColumn>& rows)
      : constraints_(system) {
    world_.SetObjects({FixedObject(RigidSurface{"plane", Plane{}})});
    constraints_.Reset(solver.factorization(), world_, BendingBlock::kTimeStep);
    std::vector<Contact> contacts;
    constraints_.SetContacts(contacts);
    for (const NodeColumn& row : rows) {
      Contact contact;
      contact.num_nodes = 1;
      contact.nodes[0] = system.free_nodes()[static_cast<std::size_t>(row.node)];
      contact.weights[0] = 1.0;
      contact.object = 0;
      contact.normal = row.value;
      contacts.push_back(contact);
      constraints_.SetContacts(contacts);  // one more every time
    }
  }
  const ConstraintOperator& constraints() const { return constraints_; }

 private:
  RigidWorld world_;
  ConstraintOperator constraints_;
};

/// Solves as a step does: with the factorisation at hand, then refined if that is an old one.
inline Eigen::VectorXd Solve(const Eigen::VectorXd& b, const ImplicitEuler* system,
                             LinearSolver* solver) {
  const Touching nothing(*system, *solver, {});
  SystemVector dv{solver->factorization().Solve(b), Eigen::VectorXd(0)};
  Eigen::VectorXd no_forces(0);
  if (!solver->current()) {
    EXPECT_TRUE(
        solver->Refine({b, Eigen::VectorXd(0)}, nothing.constraints(), {}, &dv, &no_forces));
  }
  return dv.cup;
}

}  // namespace vacuum_gripper_sim
