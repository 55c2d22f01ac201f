#include "vacuum_gripper_sim/core/implicit_euler.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/block_mesh.h"
#include "support/node_matrices.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"

namespace vacuum_gripper_sim {
namespace {

const Eigen::Vector3d kGravity(0.0, 0.0, -9.81);

/// A block of 2 x 1 x 1 cm, clamped at x = 0, with what a step of it needs.
class ImplicitEulerTest : public testing::TestWithParam<bool> {
 protected:
  const TetMesh mesh_ = MakeBlock(3, 2, 2, {0.02, 0.01, 0.01}, GetParam());
  const ElasticBody body_{mesh_, {338000.0, 0.45, 1080.0}};
  const double mass_ = 1080.0 * 0.02 * 0.01 * 0.01;

  Eigen::MatrixXd DenseA(ImplicitEuler& system) const { return Dense(system.A_ff()); }
};

// A_ff = M + h D + h^2 K on the free nodes, against the matrices assembled by triplets.
TEST_P(ImplicitEulerTest, AssemblesTheStepMatrix) {
  ImplicitEuler system(body_, mesh_.mount_nodes);
  Eigen::Matrix3Xd x = mesh_.nodes;
  x.row(2) += 0.1 * x.row(0);
  const double h = 0.01;
  const RayleighDamping damping{3.0, 2e-3};
  system.Linearize(x, Eigen::Matrix3Xd::Zero(3, x.cols()), h, damping, kGravity);
  const Eigen::MatrixXd K(body_.Stiffness(x));
  const Eigen::MatrixXd A = DenseA(system);
  const double largest = A.cwiseAbs().maxCoeff();
  for (const int a : system.free_nodes()) {
    for (const int b : system.free_nodes()) {
      Eigen::Matrix3d expected = (h * damping.stiffness + h * h) * K.block<3, 3>(3 * a, 3 * b);
      if (a == b) expected.diagonal().array() += (1.0 + h * damping.mass) * body_.masses()(a);
      const Eigen::Matrix3d actual = A.block<3, 3>(system.FreeRow(a), system.FreeRow(b));
      ASSERT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-12 * largest);
    }
  }
}

// Products, right-hand side and reaction go element by element; against the whole matrices of a
// state with bent, stretched and inverted elements whose edges are curved at rest.
TEST_P(ImplicitEulerTest, ElementLoopsAgreeWithMatrices) {
  TetMesh mesh = mesh_;
  mesh.nodes += 3e-4 * Eigen::Matrix3Xd::Random(3, mesh.nodes.cols());
  for (const MaterialModel model : {MaterialModel::kCorotational, MaterialModel::kNeoHookean}) {
    const ElasticBody body(mesh, {338000.0, 0.45, 1080.0, model});
    ImplicitEuler system(body, mesh_.mount_nodes);
    Eigen::Matrix3Xd x = mesh.nodes;
    x.row(2) += 0.3 * x.row(0);
    x.row(0) *= 1.2;
    x.col(x.cols() - 1) += Eigen::Vector3d(-0.012, 0.001, 0.002);  // through its elements
    const Eigen::Matrix3Xd v = Eigen::Matrix3Xd::Random(3, x.cols());
    const Eigen::Matrix3Xd dv = Eigen::Matrix3Xd::Random(3, x.cols());
    const double h = 0.01;
    const RayleighDamping damping{3.0, 2e-3};
    system.Linearize(x, v, h, damping, kGravity);

    const Eigen::SparseMatrix<double> K = body.Stiffness(x);
    const auto times = [&](double mass_factor, double stiffness_factor, const auto& values) {
      const Eigen::VectorXd stacked = Eigen::Map<const Eigen::VectorXd>(values.data(), x.size());
      const Eigen::VectorXd product = K * stacked;
      return Eigen::Matrix3Xd(mass_factor * values * body.masses().asDiagonal() +
                              stiffness_factor *
                                  Eigen::Map<const Eigen::Matrix3Xd>(product.data(), 3, x.cols()));
    };
    const double stiffness = h * damping.stiffness + h * h;
    const Eigen::Matrix3Xd b = h * body.InternalForce(x) +
                               h * kGravity * body.weights().transpose() -
                               times(h * damping.mass, stiffness, v);
    Eigen::Matrix3Xd dv_c(3, static_cast<Eigen::Index>(mesh_.mount_nodes.size()));
    Eigen::Matrix3Xd clamped_alone = Eigen::Matrix3Xd::Zero(3, x.cols());
    for (Eigen::Index i = 0; i < dv_c.cols(); ++i) {
      const int node = mesh_.mount_nodes[static_cast<std::size_t>(i)];
      dv_c.col(i) = dv.col(node);
      clamped_alone.col(node) = dv.col(node);
    }
    const auto near = [](const auto& actual, const auto& expected) {
      return (actual - expected).norm() < 1e-11 * expected.norm();
    };
    const double mass = 1.0 + h * damping.mass;
    const Eigen::VectorXd dv_f = system.GatherFree(dv);
    const Eigen::Matrix3Xd right = b - times(mass, stiffness, clamped_alone);
    EXPECT_TRUE(near(system.FreeRightHandSide(dv_c), system.GatherFree(right)));
    const Eigen::Matrix3Xd free_alone = dv - clamped_alone;
    const Eigen::Matrix3Xd A_dv = times(mass, stiffness, free_alone);
    EXPECT_TRUE(near(system.Multiply(dv_f), system.GatherFree(A_dv)));
    EXPECT_TRUE(near(DenseA(system) * dv_f, system.GatherFree(A_dv)));

    const Eigen::Matrix3Xd residual = times(mass, stiffness, dv) - b;
    const Eigen::Matrix3Xd reaction = system.ClampedReaction(dv_f, dv_c);
    for (Eigen::Index i = 0; i < dv_c.cols(); ++i) {
      const int node = mesh_.mount_nodes[static_cast<std::size_t>(i)];
      EXPECT_TRUE(near(reaction.col(i), residual.col(node) / h)) << node;
    }
  }
}

// Shared among threads the element loops make the same numbers, and so does an earlier state's
// product: on a block large enough to be shared.
TEST_P(ImplicitEulerTest, ACrewMakesTheSameNumbers) {
  const TetMesh mesh = MakeBlock(8, 7, 6, {0.02, 0.01, 0.01}, GetParam());
  const ElasticBody body(mesh, {338000.0, 0.45, 1080.0});
  Eigen::Matrix3Xd x = mesh.nodes;
  x.row(2) += 0.3 * x.row(0);
  const Eigen::Matrix3Xd v = Eigen::Matrix3Xd::Random(3, x.cols());
  const Eigen::Matrix3Xd held =
      Eigen::Matrix3Xd::Random(3, static_cast<Eigen::Index>(mesh.mount_nodes.size()));
  ImplicitEuler alone(body, mesh.mount_nodes);
  alone.Linearize(x, v, 0.01, {3.0, 2e-3}, kGravity);
  const Eigen::VectorXd dv = Eigen::VectorXd::Random(3 * alone.num_free());
  const Eigen::VectorXd product = alone.Multiply(dv);
  const Eigen::VectorXd right = alone.FreeRightHandSide(held);
  for (const int size : {2, 4}) {
    Crew crew(size);
    ImplicitEuler shared(body, mesh.mount_nodes);
    for (int round = 0; round < 5; ++round) {
      shared.Linearize(x, v, 0.01, {3.0, 2e-3}, kGravity, &crew);
      EXPECT_EQ(shared.Multiply(dv, &crew), product);
      EXPECT_EQ(shared.FreeRightHandSide(held), right);
    }
  }
}

// Nothing clamped, gravity alone: all momentum gained in a step is m g h, whatever the elements do.
TEST_P(ImplicitEulerTest, FreeFallGainsMomentum) {
  ImplicitEuler system(body_, {});
  const double h = 0.01;
  system.Linearize(mesh_.nodes, Eigen::Matrix3Xd::Zero(3, mesh_.num_nodes()), h, {0.0, 2e-3},
                   kGravity);
  SparseCholesky cholesky;
  cholesky.Analyze(system.matrix().pattern());
  ASSERT_TRUE(cholesky.Factorize(system.A_ff()));
  const Eigen::VectorXd dv = cholesky.Solve(system.FreeRightHandSide(Eigen::Matrix3Xd(3, 0)));
  const Eigen::Matrix3Xd velocity = system.Scatter(dv, Eigen::Matrix3Xd(3, 0));
  const Eigen::Vector3d momentum = velocity * body_.masses();
  EXPECT_LT((momentum - mass_ * h * kGravity).norm(), 1e-12 * mass_);
}

// At rest the clamp carries the weight; while it still swings, the balance holds with the momentum.
TEST_P(ImplicitEulerTest, ReactionBalancesWeightAndMomentum) {
  ImplicitEuler system(body_, mesh_.mount_nodes);
  SparseCholesky cholesky;
  cholesky.Analyze(system.matrix().pattern());
  const double h = 0.01;
  Eigen::Matrix3Xd x = mesh_.nodes;
  Eigen::Matrix3Xd v = Eigen::Matrix3Xd::Zero(3, x.cols());
  const Eigen::Matrix3Xd held =
      Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(mesh_.mount_nodes.size()));
  Eigen::Vector3d reaction;
  for (int step = 0; step < 200; ++step) {
    const Eigen::Vector3d momentum = v * body_.masses();
    system.Linearize(x, v, h, {0.0, 2e-3}, kGravity);
    ASSERT_TRUE(cholesky.Factorize(system.A_ff()));
    const Eigen::VectorXd dv = cholesky.Solve(system.FreeRightHandSide(held));
    reaction = system.ClampedReaction(dv, held).rowwise().sum();
    v += system.Scatter(dv, held);
    x += h * v;
    const Eigen::Vector3d gained = v * body_.masses() - momentum;
    ASSERT_LT((gained - h * (reaction + mass_ * kGravity)).norm(), 1e-12) << step;
  }
  EXPECT_LT((reaction + mass_ * kGravity).norm(), 1e-6 * mass_ * 9.81);
  EXPECT_LT(x.row(2).minCoeff(), -1e-6);  // it sags
}

// Thrown inside out through its clamp, every element inverted, a block of either material comes
// back.
TEST_P(ImplicitEulerTest, AnInvertedBlockRecovers) {
  for (const MaterialModel model : {MaterialModel::kCorotational, MaterialModel::kNeoHookean}) {
    const ElasticBody body(mesh_, {338000.0, 0.45, 1080.0, model});
    ImplicitEuler system(body, mesh_.mount_nodes);
    SparseCholesky cholesky;
    cholesky.Analyze(system.matrix().pattern());
    const Eigen::Matrix3Xd held =
        Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(mesh_.mount_nodes.size()));
    Eigen::Matrix3Xd x = mesh_.nodes;
    x.row(0) *= -0.5;
    Eigen::Matrix3Xd v = Eigen::Matrix3Xd::Zero(3, x.cols());
    const double h = 0.01;
    for (int step = 0; step < 300; ++step) {
      system.Linearize(x, v, h, {0.0, 2e-3}, Eigen::Vector3d::Zero());
      ASSERT_TRUE(cholesky.Factorize(system.A_ff())) << step;
      const Eigen::VectorXd dv = cholesky.Solve(system.FreeRightHandSide(held));
      v += system.Scatter(dv, held);
      x += h * v;
    }
    EXPECT_LT((x - mesh_.nodes).cwiseAbs().maxCoeff(), 1e-6) << static_cast<int>(model);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, ImplicitEulerTest, testing::Bool(),
                         [](const auto& info) { return info.param ? "Quadratic" : "Linear"; });

}  // namespace
}  // namespace vacuum_gripper_sim
