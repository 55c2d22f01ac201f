#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "vacuum_gripper_sim/core/material_model.h"

namespace vacuum_gripper_sim {

/** One tetrahedron of N nodes with Q integration points.

 Everything an element has at its nodes is stored with the nodes along the columns, padded with
 zeros to whole vector registers: lane a of column i is component i at node a. */
template <int N, int Q>
struct Tetrahedron {
  static constexpr int kNodes = N;
  static constexpr int kPoints = Q;
  static constexpr int kLanes = (N + 3) / 4 * 4;
  using NodalVectors = Eigen::Matrix<double, kLanes, 3>;
  /// Row i kLanes + a, column j kLanes + b: entry (i, j) of the block of the nodes a and b.
  using Stiffness = Eigen::Matrix<double, 3 * kLanes, 3 * kLanes>;

  std::array<int, N> nodes;               ///< Mesh nodes, VTK order.
  std::array<double, Q> weights;          ///< Rest volume of each point. [m^3]
  std::array<NodalVectors, Q> gradients;  ///< dN_a/dX at each point. [1/m]

  /// Columns of a 3 by #nodes array at the element's nodes.
  NodalVectors Gather(const Eigen::Matrix3Xd& values) const {
    NodalVectors gathered = NodalVectors::Zero();
    for (int a = 0; a < N; ++a) {
      gathered.row(a) = values.col(nodes[static_cast<std::size_t>(a)]).transpose();
    }
    return gathered;
  }

  /// The 3 by 3 block of the nodes a and b.
  static Eigen::Matrix3d Block(const Stiffness& K, int a, int b) {
    using Stride = Eigen::Stride<3 * kLanes * kLanes, kLanes>;
    return Eigen::Map<const Eigen::Matrix3d, Eigen::Unaligned, Stride>(&K(a, b));
  }
};

using LinearTetrahedron = Tetrahedron<4, 1>;
using QuadraticTetrahedron = Tetrahedron<10, 4>;

/// A law's tangents at an element's integration points.
template <typename Element, typename Law>
using PointTangents = std::array<typename Law::Tangent, Element::kPoints>;

/** Internal force and stiffness of one element whose material has the given law (Corotational- or
 NeoHookeanLaw): with the stress P and the tangent of the law at every integration point, weighted,

     f_a = -sum P dN_a/dX,    K_ab = d(P dN_a/dX) / dx_b by the law's tangent.

 One deformation gradient an integration point, not one an element, keeps a bent quadratic element
 consistent.
 @param x Positions of its nodes. [m]
 @param[out] f Force on its nodes. [N]
 @param[out] K Symmetric, positive semi-definite; only written when not null. [N/m] */
template <int N, int Q, typename Law>
void ElementForces(const Tetrahedron<N, Q>& element, const Law& law,
                   const typename Tetrahedron<N, Q>::NodalVectors& x,
                   typename Tetrahedron<N, Q>::NodalVectors* f,
                   typename Tetrahedron<N, Q>::Stiffness* K);

/// K alone, of given tangents.
template <int N, int Q, typename Law>
void ElementStiffness(const Tetrahedron<N, Q>& element, const Law& law,
                      const PointTangents<Tetrahedron<N, Q>, Law>& tangents,
                      typename Tetrahedron<N, Q>::Stiffness* K);

}  // namespace vacuum_gripper_sim
