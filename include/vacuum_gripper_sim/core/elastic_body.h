#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/** One tetrahedron of N nodes with Q integration points, and its co-rotational kernel.

 At every integration point, with F = dx/dX and R the rotation nearest to F,

     E = mu |F - R|^2 + lambda/2 tr(R^T F - I)^2                  (energy density)  [J/m^3]
     P = 2 mu (F - R) + lambda tr(R^T F - I) R                    (P = dE/dF)       [Pa]
     K_ab = w (lambda g_a g_b^T + mu g_b g_a^T + mu (g_a . g_b) I),  g_a = R dN_a/dX

 K is the derivative of the force with R held: the stiffness of linear elasticity in the rotated
 frame ([Mueller 2004], the paper's reference [3]), symmetric and positive semi-definite whatever
 the deformation, and the exact derivative at every rigidly moved rest state. One rotation an
 integration point, not one an element, keeps a bent quadratic element consistent. */
template <int N, int Q>
struct Tetrahedron {
  using Nodes3 = Eigen::Matrix<double, 3, N>;
  using Stiffness = Eigen::Matrix<double, 3 * N, 3 * N>;

  std::array<int, N> nodes;                              ///< Mesh nodes, VTK order.
  std::array<double, Q> weights;                         ///< Rest volume of each point. [m^3]
  std::array<Eigen::Matrix<double, N, 3>, Q> gradients;  ///< dN_a/dX at each point, N by 3. [1/m]

  Nodes3 Gather(const Eigen::Matrix3Xd& values) const {
    Nodes3 gathered;
    for (std::size_t a = 0; a < N; ++a) {
      gathered.col(static_cast<Eigen::Index>(a)) = values.col(nodes[a]);
    }
    return gathered;
  }
};

using LinearTetrahedron = Tetrahedron<4, 1>;
using QuadraticTetrahedron = Tetrahedron<10, 4>;

/// Lame's constants of an isotropic material. [Pa]
struct LameConstants {
  double lambda{0.0};
  double mu{0.0};
};
LameConstants Lame(const Material& material);

/** Internal force f = -dE/dx and stiffness K (see Tetrahedron) of one element.
 @param x Positions of its nodes, 3 by N. [m]
 @param[out] f Force on its nodes, 3 by N. [N]
 @param[out] K 3N by 3N, node-major; only written when not null. [N/m] */
template <int N, int Q>
void ElementForces(const Tetrahedron<N, Q>& element, const LameConstants& lame,
                   const Eigen::Matrix<double, 3, N>& x, Eigen::Matrix<double, 3, N>* f,
                   Eigen::Matrix<double, 3 * N, 3 * N>* K);

/** The cup as a co-rotational finite-element body of linear or quadratic tetrahedra.

 [Mueller 2004] M. Mueller, M. Gross, "Interactive virtual materials", Graphics Interface 2004. */
class ElasticBody {
 public:
  using Elements = std::variant<std::vector<LinearTetrahedron>, std::vector<QuadraticTetrahedron>>;

  ElasticBody(const TetMesh& mesh, const Material& material);

  int num_nodes() const { return static_cast<int>(masses_.size()); }
  const Elements& elements() const { return elements_; }
  const LameConstants& lame() const { return lame_; }

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
  LameConstants lame_;
  Eigen::VectorXd masses_;
  Eigen::VectorXd weights_;
};

}  // namespace vacuum_gripper_sim
