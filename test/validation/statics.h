#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <variant>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/elastic_body.h"

namespace vacuum_gripper_sim {

/** Static equilibrium of an ElasticBody whose nodes `clamped` are held at rest, under dead loads
 and the follower pressure of a surface, by Newton's method with load steps.

 The stiffness that the simulator uses holds the rotations and leaves out the load's own change;
 here the tangent is exact (central differences of the element forces, the derivative of the area
 vectors), so that what is converged is the equilibrium of the simulator's own forces. */
class Statics {
 public:
  Statics(const TetMesh& mesh, const Material& material, const std::vector<int>& clamped)
      : body_(mesh, material),
        rest_(mesh.nodes),
        dead_load_(Eigen::Matrix3Xd::Zero(3, mesh.num_nodes())),
        row_(static_cast<std::size_t>(mesh.num_nodes()), 0) {
    for (const int node : clamped) row_[static_cast<std::size_t>(node)] = -1;
    for (int& row : row_) {
      if (row < 0) continue;
      row = num_rows_;
      num_rows_ += 3;
    }
  }

  /// Forces that keep their direction, 3 by #nodes. [N]
  void SetDeadLoad(const Eigen::Matrix3Xd& load) { dead_load_ = load; }

  /// Pressure on the surface's points, along its area vectors. [Pa]
  void SetPressure(const CavitySurface& surface, double pressure) {
    surface_ = &surface;
    pressure_ = pressure;
  }

  struct Solution {
    Eigen::Matrix3Xd x;       ///< Positions, 3 by #nodes. [m]
    Eigen::Vector3d support;  ///< Force of the clamp on the body. [N]
  };

  /// @throws std::runtime_error if an increment does not converge.
  Solution Solve(int increments) const {
    Solution solution{rest_, Eigen::Vector3d::Zero()};
    for (int i = 1; i <= increments; ++i) {
      Equilibrate(static_cast<double>(i) / increments, &solution.x);
    }
    const Eigen::Matrix3Xd residual = body_.InternalForce(solution.x) + Load(1.0, solution.x);
    for (std::size_t n = 0; n < row_.size(); ++n) {
      if (row_[n] < 0) solution.support -= residual.col(static_cast<Eigen::Index>(n));
    }
    return solution;
  }

 private:
  static constexpr double kTolerance = 1e-9;  // of the last change; it shrinks quadratically [m]
  static constexpr int kMaxIterations = 40;   // of one increment
  static constexpr double kDifferenceStep = 1e-8;  // [m]

  Eigen::Matrix3Xd Load(double factor, const Eigen::Matrix3Xd& x) const {
    Eigen::Matrix3Xd load = factor * dead_load_;
    if (surface_ != nullptr) {
      const Eigen::Matrix3Xd areas = PointAreaVectors(*surface_, x);
      for (int i = 0; i < surface_->num_points(); ++i) {
        load.col(surface_->nodes[static_cast<std::size_t>(i)]) += factor * pressure_ * areas.col(i);
      }
    }
    return load;
  }

  Eigen::VectorXd Residual(double factor, const Eigen::Matrix3Xd& x) const {
    const Eigen::Matrix3Xd force = body_.InternalForce(x) + Load(factor, x);
    Eigen::VectorXd residual(num_rows_);
    for (std::size_t n = 0; n < row_.size(); ++n) {
      if (row_[n] >= 0) residual.segment<3>(row_[n]) = force.col(static_cast<Eigen::Index>(n));
    }
    return residual;
  }

  using Triplets = std::vector<Eigen::Triplet<double>>;

  void AddBlock(int row_node, int column_node, const Eigen::Matrix3d& block,
                Triplets* triplets) const {
    const int row = row_[static_cast<std::size_t>(row_node)];
    const int column = row_[static_cast<std::size_t>(column_node)];
    if (row < 0 || column < 0) return;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) triplets->emplace_back(row + i, column + j, block(i, j));
    }
  }

  template <typename Element, typename Law>
  void AddElement(const Element& element, const Law& law, const Eigen::Matrix3Xd& x,
                  Triplets* triplets) const {
    using NodalVectors = typename Element::NodalVectors;
    NodalVectors x_e = element.Gather(x);
    Eigen::Matrix<double, 3 * Element::kNodes, 3 * Element::kNodes> tangent;
    for (int b = 0; b < Element::kNodes; ++b) {
      for (int j = 0; j < 3; ++j) {
        const double at = x_e(j, b);
        NodalVectors ahead;
        NodalVectors behind;
        x_e(j, b) = at + kDifferenceStep;
        ElementForces(element, law, x_e, &ahead, nullptr);
        x_e(j, b) = at - kDifferenceStep;
        ElementForces(element, law, x_e, &behind, nullptr);
        x_e(j, b) = at;
        const Eigen::Matrix<double, 3, Element::kNodes> slope =
            (behind - ahead).template topRows<3>() / (2.0 * kDifferenceStep);
        tangent.col(3 * b + j) = Eigen::Map<const Eigen::VectorXd>(slope.data(), slope.size());
      }
    }
    for (int a = 0; a < Element::kNodes; ++a) {
      for (int b = 0; b < Element::kNodes; ++b) {
        AddBlock(element.nodes[static_cast<std::size_t>(a)],
                 element.nodes[static_cast<std::size_t>(b)],
                 tangent.template block<3, 3>(3 * a, 3 * b), triplets);
      }
    }
  }

  /// Adds -d(load)/dx of the pressure: a triangle's share is p/6 (b - a) x (c - a).
  void AddPressure(double pressure, const Eigen::Matrix3Xd& x, Triplets* triplets) const {
    const auto cross = [](const Eigen::Vector3d& v) {
      Eigen::Matrix3d matrix;
      matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
      return matrix;
    };
    for (int t = 0; t < surface_->triangles.cols(); ++t) {
      int nodes[3];
      for (int k = 0; k < 3; ++k) {
        nodes[k] = surface_->nodes[static_cast<std::size_t>(surface_->triangles(k, t))];
      }
      for (int k = 0; k < 3; ++k) {
        // The area vector changes with corner k by (opposite edge) x (its motion) / 2.
        const Eigen::Vector3d edge = x.col(nodes[(k + 2) % 3]) - x.col(nodes[(k + 1) % 3]);
        for (const int row_node : nodes) {
          AddBlock(row_node, nodes[k], -pressure / 6.0 * cross(edge), triplets);
        }
      }
    }
  }

  Eigen::SparseMatrix<double> Tangent(double factor, const Eigen::Matrix3Xd& x) const {
    Triplets triplets;
    std::visit(
        [&](const auto& elements, const auto& law) {
          for (const auto& element : elements) AddElement(element, law, x, &triplets);
        },
        body_.elements(), body_.law());
    if (surface_ != nullptr) AddPressure(factor * pressure_, x, &triplets);
    Eigen::SparseMatrix<double> tangent(num_rows_, num_rows_);
    tangent.setFromTriplets(triplets.begin(), triplets.end());
    return tangent;
  }

  void Equilibrate(double factor, Eigen::Matrix3Xd* x) const {
    double change = 0.0;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      const Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(Tangent(factor, *x));
      if (solver.info() != Eigen::Success) break;
      const Eigen::VectorXd step = solver.solve(Residual(factor, *x));
      for (std::size_t n = 0; n < row_.size(); ++n) {
        if (row_[n] >= 0) x->col(static_cast<Eigen::Index>(n)) += step.segment<3>(row_[n]);
      }
      change = step.cwiseAbs().maxCoeff();
      if (change <= kTolerance) return;
    }
    std::ostringstream message;
    message << "no static equilibrium at " << factor << " of the load: last change " << change
            << " m";
    throw std::runtime_error(message.str());
  }

  ElasticBody body_;
  Eigen::Matrix3Xd rest_;
  Eigen::Matrix3Xd dead_load_;
  const CavitySurface* surface_{nullptr};
  double pressure_{0.0};
  std::vector<int> row_;  // first of a node's three rows; -1: clamped
  int num_rows_{0};
};

/// Consistent nodal loads of a uniform traction whose resultant is `force`, on flat faces of a
/// group; 3 by #nodes. [N]
inline Eigen::Matrix3Xd UniformTraction(const TetMesh& mesh, const Eigen::MatrixXi& faces,
                                        const Eigen::Vector3d& force) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(mesh.num_nodes());
  for (int f = 0; f < faces.cols(); ++f) {
    const Eigen::Vector3d a = mesh.nodes.col(faces(0, f));
    const Eigen::Vector3d b = mesh.nodes.col(faces(1, f));
    const Eigen::Vector3d c = mesh.nodes.col(faces(2, f));
    const double third = (b - a).cross(c - a).norm() / 6.0;
    // A straight 6-node face carries a uniform load at its mid-edge nodes alone.
    const Eigen::Index first = faces.rows() - 3;
    for (Eigen::Index k = first; k < first + 3; ++k) weights(faces(k, f)) += third;
  }
  return force * (weights / weights.sum()).transpose();
}

}  // namespace vacuum_gripper_sim
