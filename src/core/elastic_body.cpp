#include "vacuum_gripper_sim/core/elastic_body.h"

#include <Eigen/LU>
#include <cstddef>

#include "vacuum_gripper_sim/core/element_order.h"

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
  std::array<Eigen::Vector4d, 4> points;
  for (int q = 0; q < 4; ++q) {
    points[static_cast<std::size_t>(q)] = Eigen::Vector4d::Constant(kFarCoordinate);
    points[static_cast<std::size_t>(q)](q) = 1.0 - 3.0 * kFarCoordinate;
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

  std::vector<Tetrahedron<N, Q>> elements;
  elements.reserve(static_cast<std::size_t>(mesh.num_elements()));
  for (const int e : OrderByNeighbours(mesh)) {
    Tetrahedron<N, Q>& element = elements.emplace_back();
    for (int a = 0; a < N; ++a) element.nodes[static_cast<std::size_t>(a)] = mesh.elements(a, e);
    const auto X = element.Gather(mesh.nodes);
    double volume = 0.0;
    for (std::size_t q = 0; q < Q; ++q) {
      const ShapeFunctions<N> shape = shape_at(points[q]);
      const Eigen::Matrix<double, N, 3> local = shape.derivatives * to_local;
      const Eigen::Matrix3d J = X.template topRows<3>() * local;
      element.dL_dX[q] = J.inverse();
      element.gradients[q].setZero();
      element.gradients[q].template topRows<3>() = (local * element.dL_dX[q]).transpose();
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

ElasticBody::ElasticBody(const TetMesh& mesh, const Material& material)
    : law_(MakeMaterialLaw(material)),
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
      [&](const auto& elements, const auto& law) {
        for (const auto& element : elements) {
          const auto x_e = element.Gather(x);
          for (std::size_t q = 0; q < element.weights.size(); ++q) {
            energy += element.weights[q] * law.EnergyDensity(element.Gradient(x_e, q));
          }
        }
      },
      elements_, law_);
  return energy;
}

Eigen::Matrix3Xd ElasticBody::InternalForce(const Eigen::Matrix3Xd& x) const {
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, x.cols());
  std::visit(
      [&](const auto& elements, const auto& law) {
        for (const auto& element : elements) {
          auto f_e = element.Gather(x);
          ElementForces(element, law, element.Gather(x), &f_e, nullptr);
          for (std::size_t a = 0; a < element.nodes.size(); ++a) {
            force.col(element.nodes[a]) += f_e.col(static_cast<Eigen::Index>(a)).template head<3>();
          }
        }
      },
      elements_, law_);
  return force;
}

Eigen::SparseMatrix<double> ElasticBody::Stiffness(const Eigen::Matrix3Xd& x) const {
  std::vector<Eigen::Triplet<double>> triplets;
  std::visit(
      [&](const auto& elements, const auto& law) {
        using Element = typename std::decay_t<decltype(elements)>::value_type;
        using Law = std::decay_t<decltype(law)>;
        typename Element::NodalVectors f_e;
        PointTangents<Element, Law> tangents;
        for (const auto& element : elements) {
          ElementForces(element, law, element.Gather(x), &f_e, &tangents);
          const ElementStiffness<Element, Law> K_e(element, law, tangents, 1.0);
          for (int b = 0; b < Element::kNodes; ++b) {
            for (int a = 0; a < Element::kNodes; ++a) {
              const NodeBlock block = K_e(a, b);
              const int row = 3 * element.nodes[static_cast<std::size_t>(a)];
              const int column = 3 * element.nodes[static_cast<std::size_t>(b)];
              for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < 3; ++i) {
                  triplets.emplace_back(row + i, column + j, block(i, j));
                }
              }
            }
          }
        }
      },
      elements_, law_);
  const Eigen::Index size = 3 * x.cols();
  Eigen::SparseMatrix<double> K(size, size);
  K.setFromTriplets(triplets.begin(), triplets.end());
  return K;
}

}  // namespace vacuum_gripper_sim
