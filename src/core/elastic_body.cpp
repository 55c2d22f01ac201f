#include "vacuum_gripper_sim/core/elastic_body.h"

#include <Eigen/LU>
#include <cmath>
#include <cstddef>

#include "vacuum_gripper_sim/core/polar_decomposition.h"

namespace vacuum_gripper_sim {
namespace {

/// Shape functions and their derivatives by the barycentric coordinates L0..L3.
template <int N>
struct ShapeFunctions {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, 4> derivatives;
};

ShapeFunctions<4> LinearShape(const Eigen::Vector4d& L) { return {L, Eigen::Matrix4d::Identity()}; }

ShapeFunctions<10> QuadraticShape(const Eigen::Vector4d& L) {
  constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  ShapeFunctions<10> shape;
  shape.derivatives.setZero();
  for (int a = 0; a < 4; ++a) {
    shape.values(a) = L(a) * (2.0 * L(a) - 1.0);
    shape.derivatives(a, a) = 4.0 * L(a) - 1.0;
  }
  for (int e = 0; e < 6; ++e) {
    const int i = kEdges[e][0];
    const int j = kEdges[e][1];
    shape.values(4 + e) = 4.0 * L(i) * L(j);
    shape.derivatives(4 + e, i) = 4.0 * L(j);
    shape.derivatives(4 + e, j) = 4.0 * L(i);
  }
  return shape;
}

/// Integration points in barycentric coordinates, each with the same share of the volume.
std::array<Eigen::Vector4d, 1> LinearPoints() { return {Eigen::Vector4d::Constant(0.25)}; }

std::array<Eigen::Vector4d, 4> QuadraticPoints() {
  const double b = (5.0 - std::sqrt(5.0)) / 20.0;  // exact for polynomials of degree 2
  std::array<Eigen::Vector4d, 4> points;
  for (int q = 0; q < 4; ++q) {
    points[static_cast<std::size_t>(q)] = Eigen::Vector4d::Constant(b);
    points[static_cast<std::size_t>(q)](q) = 1.0 - 3.0 * b;
  }
  return points;
}

template <int N, int Q, typename Shape>
std::vector<Tetrahedron<N, Q>> MakeElements(const TetMesh& mesh,
                                            const std::array<Eigen::Vector4d, Q>& points,
                                            const Shape& shape_at,
                                            const std::array<double, N>& mass_shares,
                                            double density, Eigen::VectorXd* masses,
                                            Eigen::VectorXd* weights) {
  // Local coordinates are L1, L2, L3 with L0 = 1 - L1 - L2 - L3.
  Eigen::Matrix<double, 4, 3> to_local;
  to_local << -1.0, -1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0;

  std::vector<Tetrahedron<N, Q>> elements(static_cast<std::size_t>(mesh.num_elements()));
  for (int e = 0; e < mesh.num_elements(); ++e) {
    Tetrahedron<N, Q>& element = elements[static_cast<std::size_t>(e)];
    for (int a = 0; a < N; ++a) element.nodes[static_cast<std::size_t>(a)] = mesh.elements(a, e);
    const Eigen::Matrix<double, 3, N> X = element.Gather(mesh.nodes);
    double volume = 0.0;
    for (std::size_t q = 0; q < Q; ++q) {
      const ShapeFunctions<N> shape = shape_at(points[q]);
      const Eigen::Matrix<double, N, 3> local = shape.derivatives * to_local;
      const Eigen::Matrix3d J = X * local;
      element.gradients[q] = local * J.inverse();
      element.weights[q] = J.determinant() / (6.0 * Q);
      volume += element.weights[q];
      for (int a = 0; a < N; ++a) {
        (*weights)(element.nodes[static_cast<std::size_t>(a)]) +=
            density * element.weights[q] * shape.values(a);
      }
    }
    for (std::size_t a = 0; a < N; ++a) {
      (*masses)(element.nodes[a]) += density * volume * mass_shares[a];
    }
  }
  return elements;
}

}  // namespace

LameConstants Lame(const Material& material) {
  const double E = material.young_modulus;
  const double nu = material.poisson_ratio;
  return {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))};
}

template <int N, int Q>
void ElementForces(const Tetrahedron<N, Q>& element, const LameConstants& lame,
                   const Eigen::Matrix<double, 3, N>& x, Eigen::Matrix<double, 3, N>* f,
                   Eigen::Matrix<double, 3 * N, 3 * N>* K) {
  f->setZero();
  if (K != nullptr) K->setZero();
  for (std::size_t q = 0; q < Q; ++q) {
    const Eigen::Matrix<double, N, 3>& G = element.gradients[q];
    const double w = element.weights[q];
    const Eigen::Matrix3d F = x * G;
    const Eigen::Matrix3d R = RotationOf(F);
    const double trace = R.cwiseProduct(F).sum() - 3.0;  // tr(R^T F - I)
    const Eigen::Matrix3d P = 2.0 * lame.mu * (F - R) + lame.lambda * trace * R;
    f->noalias() -= w * P * G.transpose();
    if (K == nullptr) continue;

    const Eigen::Matrix<double, 3, N> g = R * G.transpose();
    const double w_lambda = w * lame.lambda;
    const double w_mu = w * lame.mu;
    for (int b = 0; b < N; ++b) {
      const Eigen::Vector3d lambda_g_b = w_lambda * g.col(b);
      const Eigen::Vector3d mu_g_b = w_mu * g.col(b);
      for (int a = b; a < N; ++a) {  // the lower triangle of blocks
        const Eigen::Vector3d g_a = g.col(a);
        Eigen::Matrix3d block = g_a * lambda_g_b.transpose();
        block.noalias() += mu_g_b * g_a.transpose();
        block.diagonal().array() += g_a.dot(mu_g_b);
        K->template block<3, 3>(3 * a, 3 * b) += block;
      }
    }
  }
  if (K != nullptr) {
    for (int b = 0; b < N; ++b) {
      for (int a = b + 1; a < N; ++a) {
        K->template block<3, 3>(3 * b, 3 * a) = K->template block<3, 3>(3 * a, 3 * b).transpose();
      }
    }
  }
}

template void ElementForces(const LinearTetrahedron&, const LameConstants&,
                            const LinearTetrahedron::Nodes3&, LinearTetrahedron::Nodes3*,
                            LinearTetrahedron::Stiffness*);
template void ElementForces(const QuadraticTetrahedron&, const LameConstants&,
                            const QuadraticTetrahedron::Nodes3&, QuadraticTetrahedron::Nodes3*,
                            QuadraticTetrahedron::Stiffness*);

ElasticBody::ElasticBody(const TetMesh& mesh, const Material& material)
    : lame_(Lame(material)),
      masses_(Eigen::VectorXd::Zero(mesh.num_nodes())),
      weights_(Eigen::VectorXd::Zero(mesh.num_nodes())) {
  if (mesh.quadratic()) {
    constexpr double c = 1.0 / 36.0;
    constexpr double m = 4.0 / 27.0;
    elements_ =
        MakeElements<10, 4>(mesh, QuadraticPoints(), QuadraticShape, {c, c, c, c, m, m, m, m, m, m},
                            material.density, &masses_, &weights_);
  } else {
    elements_ = MakeElements<4, 1>(mesh, LinearPoints(), LinearShape, {0.25, 0.25, 0.25, 0.25},
                                   material.density, &masses_, &weights_);
  }
}

double ElasticBody::Energy(const Eigen::Matrix3Xd& x) const {
  double energy = 0.0;
  std::visit(
      [&](const auto& elements) {
        for (const auto& element : elements) {
          const auto x_e = element.Gather(x);
          for (std::size_t q = 0; q < element.weights.size(); ++q) {
            const Eigen::Matrix3d F = x_e * element.gradients[q];
            const Eigen::Matrix3d R = RotationOf(F);
            const double trace = R.cwiseProduct(F).sum() - 3.0;
            energy += element.weights[q] *
                      (lame_.mu * (F - R).squaredNorm() + 0.5 * lame_.lambda * trace * trace);
          }
        }
      },
      elements_);
  return energy;
}

Eigen::Matrix3Xd ElasticBody::InternalForce(const Eigen::Matrix3Xd& x) const {
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, x.cols());
  std::visit(
      [&](const auto& elements) {
        for (const auto& element : elements) {
          auto x_e = element.Gather(x);
          auto f_e = x_e;
          ElementForces(element, lame_, x_e, &f_e, nullptr);
          for (std::size_t a = 0; a < element.nodes.size(); ++a) {
            force.col(element.nodes[a]) += f_e.col(static_cast<Eigen::Index>(a));
          }
        }
      },
      elements_);
  return force;
}

Eigen::SparseMatrix<double> ElasticBody::Stiffness(const Eigen::Matrix3Xd& x) const {
  std::vector<Eigen::Triplet<double>> triplets;
  std::visit(
      [&](const auto& elements) {
        using Element = typename std::decay_t<decltype(elements)>::value_type;
        typename Element::Nodes3 f_e;
        typename Element::Stiffness K_e;
        for (const auto& element : elements) {
          ElementForces(element, lame_, element.Gather(x), &f_e, &K_e);
          for (int j = 0; j < K_e.cols(); ++j) {
            for (int i = 0; i < K_e.rows(); ++i) {
              triplets.emplace_back(3 * element.nodes[static_cast<std::size_t>(i / 3)] + i % 3,
                                    3 * element.nodes[static_cast<std::size_t>(j / 3)] + j % 3,
                                    K_e(i, j));
            }
          }
        }
      },
      elements_);
  const Eigen::Index size = 3 * x.cols();
  Eigen::SparseMatrix<double> K(size, size);
  K.setFromTriplets(triplets.begin(), triplets.end());
  return K;
}

}  // namespace vacuum_gripper_sim
