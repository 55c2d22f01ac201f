#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <variant>
#include <vector>

#include "vacuum_gripper_sim/core/material_model.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"
#include "vacuum_gripper_sim/core/tetrahedron.h"

namespace vacuum_gripper_sim {

/// The cup as a finite-element body of linear or quadratic tetrahedra.
class ElasticBody {
 public:
  using Elements = std::variant<std::vector<LinearTetrahedron>, std::vector<QuadraticTetrahedron>>;

  ElasticBody(const TetMesh& mesh, const Material& material);

  int num_nodes() const { return static_cast<int>(masses_.size()); }
  /// In the order of OrderByNeighbours().
  const Elements& elements() const { return elements_; }
  const MaterialLaw& law() const { return law_; }

  /// Lumped mass of each node, #nodes. [kg] Diagonal scaling of [Hinton 1976]: 1/36 of an element's
  /// mass to each corner and 4/27 to each mid-edge node, a quarter to each node of a linear one.
  const Eigen::VectorXd& masses() const { return masses_; }

  /// Integral of density times shape function, #nodes: gravity on node i is g times it. [kg]
  const Eigen::VectorXd& weights() const { return weights_; }

  /// Elastic energy. @param x 3 by #nodes. [m] @returns [J]
  double Energy(const Eigen::Matrix3Xd& x) const;

  /// Internal force f = -dE/dx. @param x 3 by #nodes. [m] @returns 3 by #nodes. [N]
  Eigen::Matrix3Xd InternalForce(const Eigen::Matrix3Xd& x) const;

  /// Stiffness K, 3 #nodes square, for tests and tools; stepping assembles without it. [N/m]
  Eigen::SparseMatrix<double> Stiffness(const Eigen::Matrix3Xd& x) const;

 private:
  Elements elements_;
  MaterialLaw law_;
  Eigen::VectorXd masses_;
  Eigen::VectorXd weights_;
};

}  // namespace vacuum_gripper_sim
