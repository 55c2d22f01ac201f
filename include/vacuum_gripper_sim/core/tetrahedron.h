#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

#include "vacuum_gripper_sim/core/material_model.h"
#include "vacuum_gripper_sim/core/node_matrix.h"

namespace vacuum_gripper_sim {

/// One tetrahedron of N nodes with Q integration points.
template <int N, int Q>
struct Tetrahedron {
  static constexpr int kNodes = N;
  static constexpr int kPoints = Q;
  /// A vector at each node, a column each, with a fourth row of zeros to fill a vector register.
  using NodalVectors = Eigen::Matrix<double, 4, N>;

  std::array<int, N> nodes;               ///< Mesh nodes, VTK order.
  std::array<double, Q> weights;          ///< Rest volume of each point. [m^3]
  std::array<NodalVectors, Q> gradients;  ///< dN_a/dX at each point. [1/m]
  /// Of the barycentric coordinates L1 .. L3, a row each, at each point. [1/m]
  std::array<Eigen::Matrix3d, Q> dL_dX;

  /// Columns of a 3 by #nodes array at the element's nodes.
  NodalVectors Gather(const Eigen::Matrix3Xd& values) const {
    NodalVectors gathered = NodalVectors::Zero();
    for (int a = 0; a < N; ++a) {
      gathered.col(a).template head<3>() = values.col(nodes[static_cast<std::size_t>(a)]);
    }
    return gathered;
  }

  /// Of a field given at the nodes, at a point, by the rest position.
  Eigen::Matrix3d Gradient(const NodalVectors& values, std::size_t point) const {
    return values.template topRows<3>().lazyProduct(
        gradients[point].template topRows<3>().transpose());
  }
};

/// With its point in the middle.
using LinearTetrahedron = Tetrahedron<4, 1>;
/// With a point near each corner, in the order of these.
using QuadraticTetrahedron = Tetrahedron<10, 4>;
/// A quadratic tetrahedron's points: their barycentric coordinates by the three farther corners,
/// (5 - sqrt 5) / 20, for which polynomials of degree 2 are integrated exactly.
constexpr double kFarCoordinate = 0.138196601125010515;

/// A law's tangents at an element's integration points.
template <typename Element, typename Law>
using PointTangents = std::array<typename Law::Tangent, Element::kPoints>;

/** Internal force of one element whose material has the given law (Corotational- or
 NeoHookeanLaw): with its stress P at every integration point, weighted,

     f_a = -sum P dN_a/dX.

 One deformation gradient an integration point, not one an element, keeps a bent quadratic element
 consistent.
 @param x Positions of its nodes. [m]
 @param[out] f Force on its nodes. [N]
 @param[out] tangents Only written when not null. */
template <int N, int Q, typename Law>
void ElementForces(const Tetrahedron<N, Q>& element, const Law& law,
                   const typename Tetrahedron<N, Q>::NodalVectors& x,
                   typename Tetrahedron<N, Q>::NodalVectors* f,
                   PointTangents<Tetrahedron<N, Q>, Law>* tangents);

/** A multiple of the stiffness of one element, K_ab = d(sum of P dN_a/dX) / dx_b by the law's
 tangents, block by block. K is symmetric and positive semi-definite. */
template <typename Element, typename Law>
class ElementStiffness;

/// dP = lambda (R : dF) R + mu (dF + R dF^T R) gives, with g_a = R dN_a/dX,
///
///     K_ab = lambda C_ab + mu C_ab^T + mu tr(C_ab) I,   C_ab = sum of weight g_a g_b^T.
///
/// All C_ab are one product of long columns, and C_ab^T is C_ba.
template <typename Element>
class ElementStiffness<Element, CorotationalLaw> {
 public:
  /// @param factor K is multiplied by it; >= 0.
  ElementStiffness(const Element& element, const CorotationalLaw& law,
                   const PointTangents<Element, CorotationalLaw>& tangents, double factor)
      : lambda_(law.lame().lambda), mu_(law.lame().mu) {
    std::array<Column, Element::kPoints> g;  // of all nodes, times the root of the weight
    for (std::size_t q = 0; q < tangents.size(); ++q) {
      NodeBlock R;
      R << std::sqrt(factor * element.weights[q]) * tangents[q].R, Eigen::RowVector3d::Zero();
      Eigen::Map<typename Element::NodalVectors>(g[q].data()).noalias() =
          R.lazyProduct(element.gradients[q].template topRows<3>());
    }
    for (int b = 0; b < Element::kNodes; ++b) {
      for (int j = 0; j < 3; ++j) {
        Column sum = g[0][4 * b + j] * g[0];
        for (std::size_t q = 1; q < g.size(); ++q) sum += g[q][4 * b + j] * g[q];
        C_.col(3 * b + j) = sum;
      }
    }
  }

  /// Block of the nodes a and b.
  NodeBlock operator()(int a, int b) const {
    const auto C_ab = C_.template block<4, 3>(4 * a, 3 * b);
    const auto C_ba = C_.template block<4, 3>(4 * b, 3 * a);
    const double trace = C_ab(0, 0) + C_ab(1, 1) + C_ab(2, 2);
    return lambda_ * C_ab + mu_ * C_ba + mu_ * trace * identity_;
  }

 private:
  using Column = Eigen::Matrix<double, 4 * Element::kNodes, 1>;  // as NodalVectors

  double lambda_, mu_;
  Eigen::Matrix<double, 4 * Element::kNodes, 3 * Element::kNodes> C_;
  NodeBlock identity_ = NodeBlock::Identity();
};

/// Any tangent: K_ab(i, k) is the sum over J, L of dN_a/dX_J tangent(iJ, kL) dN_b/dX_L.
template <typename Element>
class ElementStiffness<Element, NeoHookeanLaw> {
 public:
  /// @param factor K is multiplied by it; >= 0.
  ElementStiffness(const Element& element, const NeoHookeanLaw&,
                   const PointTangents<Element, NeoHookeanLaw>& tangents, double factor)
      : element_(&element) {
    for (std::size_t q = 0; q < tangents.size(); ++q) {
      const Eigen::Matrix<double, 3, Element::kNodes> weighted =
          factor * element.weights[q] * element.gradients[q].template topRows<3>();
      for (int b = 0; b < Element::kNodes; ++b) {
        for (int k = 0; k < 3; ++k) {
          const Eigen::Matrix<double, 9, 1> change = tangents[q].col(k) * weighted(0, b) +
                                                     tangents[q].col(k + 3) * weighted(1, b) +
                                                     tangents[q].col(k + 6) * weighted(2, b);
          Change(q, b, k) << Eigen::Map<const Eigen::Matrix3d>(change.data()),
              Eigen::RowVector3d::Zero();
        }
      }
    }
  }

  /// Block of the nodes a and b.
  NodeBlock operator()(int a, int b) const {
    NodeBlock K_ab = NodeBlock::Zero();
    for (std::size_t q = 0; q < Element::kPoints; ++q) {
      const Eigen::Vector3d gradient = element_->gradients[q].col(a).template head<3>();
      for (int k = 0; k < 3; ++k) K_ab.col(k) += Change(q, b, k).lazyProduct(gradient);
    }
    return K_ab;
  }

 private:
  static std::size_t Index(std::size_t q, int b, int k) {
    return (q * Element::kNodes + static_cast<std::size_t>(b)) * 3 + static_cast<std::size_t>(k);
  }
  /// Of P at a point, weighted, while component k of node b moves.
  NodeBlock& Change(std::size_t q, int b, int k) { return changes_[Index(q, b, k)]; }
  const NodeBlock& Change(std::size_t q, int b, int k) const { return changes_[Index(q, b, k)]; }

  const Element* element_;
  std::array<NodeBlock, 3 * Element::kNodes * Element::kPoints> changes_;
};

}  // namespace vacuum_gripper_sim
