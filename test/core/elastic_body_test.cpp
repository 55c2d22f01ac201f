#include "vacuum_gripper_sim/core/elastic_body.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>
#include <string>
#include <tuple>

#include "support/block_mesh.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kYoung = 338000.0;  // Pa
constexpr double kPoisson = 0.45;

/// Both element orders and materials see the same questions.
class ElasticBodyTest : public testing::TestWithParam<std::tuple<bool, MaterialModel>> {
 protected:
  const TetMesh mesh_ = MakeBlock(2, 2, 3, {0.02, 0.01, 0.03}, std::get<0>(GetParam()));
  const ElasticBody body_{mesh_, {kYoung, kPoisson, 1080.0, std::get<1>(GetParam())}};

  Eigen::Matrix3d Stress(const Eigen::Matrix3d& F) const {
    return std::visit([&](const auto& law) { return law.Stress(F, nullptr); }, body_.law());
  }

  Eigen::Matrix3Xd Perturbed(double amplitude) const {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
    return mesh_.nodes.unaryExpr([&](double x) { return x + uniform(random); });
  }
};

// rho V shared among the nodes, whatever the order.
TEST_P(ElasticBodyTest, MassIsDensityTimesVolume) {
  const double mass = 1080.0 * 0.02 * 0.01 * 0.03;
  EXPECT_NEAR(body_.masses().sum(), mass, 1e-12 * mass);
  EXPECT_NEAR(body_.weights().sum(), mass, 1e-12 * mass);
  EXPECT_GT(body_.masses().minCoeff(), 0.0);
}

TEST_P(ElasticBodyTest, RigidMotionGivesNoForce) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).matrix();
  X.translation() = Eigen::Vector3d(0.1, -3.0, 0.7);
  const Eigen::Matrix3Xd force = body_.InternalForce(X * mesh_.nodes);
  EXPECT_LT(force.cwiseAbs().maxCoeff(), 1e-10);           // E A is about 100 N
  EXPECT_NEAR(body_.Energy(X * mesh_.nodes), 0.0, 1e-14);  // E V is 2 J
}

// Patch test: under x = F X the stress is the constant P(F), so inner nodes are free of force. One
// F is a small strain, one a large stretch.
TEST_P(ElasticBodyTest, PatchTest) {
  Eigen::Matrix3d eps;
  eps << 2e-3, 3e-4, -2e-4, 3e-4, -1e-3, 1e-4, -2e-4, 1e-4, 5e-4;
  for (const double scale : {1.0, 150.0}) {
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + scale * eps;
    const Eigen::Matrix3Xd force = body_.InternalForce(F * mesh_.nodes);
    Eigen::Matrix3d virtual_work = Eigen::Matrix3d::Zero();
    for (int n = 0; n < mesh_.num_nodes(); ++n) {
      const Eigen::Vector3d X = mesh_.nodes.col(n);
      const bool inner = X.x() > 1e-9 && X.x() < 0.02 - 1e-9 && X.y() > 1e-9 &&
                         X.y() < 0.01 - 1e-9 && X.z() > 1e-9 && X.z() < 0.03 - 1e-9;
      if (inner) {
        EXPECT_LT(force.col(n).norm(), 1e-12 * scale);
      }
      virtual_work -= force.col(n) * X.transpose();  // of the displacement e_i X_j
    }
    // Principle of virtual work: P times the volume.
    EXPECT_LT((virtual_work - Stress(F) * (0.02 * 0.01 * 0.03)).norm(), 1e-12 * scale);
  }
}

TEST_P(ElasticBodyTest, ForceIsMinusTheGradientOfTheEnergy) {
  const Eigen::Matrix3Xd x = Perturbed(1e-3);
  const Eigen::Matrix3Xd force = body_.InternalForce(x);
  const double step = 1e-7;
  for (int n = 0; n < mesh_.num_nodes(); n += 5) {
    for (int i = 0; i < 3; ++i) {
      Eigen::Matrix3Xd plus = x;
      Eigen::Matrix3Xd minus = x;
      plus(i, n) += step;
      minus(i, n) -= step;
      const double slope = (body_.Energy(plus) - body_.Energy(minus)) / (2.0 * step);
      EXPECT_NEAR(force(i, n), -slope, 1e-6 * force.cwiseAbs().maxCoeff());
    }
  }
}

// With the rotation held, or its negative eigenvalues left out, K is the derivative of the force;
// at a rotated rest state nothing is held back, so there it is the exact one.
TEST_P(ElasticBodyTest, StiffnessIsTheDerivativeOfTheForceAtARotatedRestState) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(0.3, 1.0, -0.4).normalized()).matrix();
  const Eigen::Matrix3Xd x = R * mesh_.nodes;
  const Eigen::SparseMatrix<double> K = body_.Stiffness(x);
  const double largest = Eigen::MatrixXd(K).cwiseAbs().maxCoeff();
  const double step = 1e-8;
  for (int n = 0; n < mesh_.num_nodes(); n += 7) {
    for (int i = 0; i < 3; ++i) {
      Eigen::Matrix3Xd plus = x;
      Eigen::Matrix3Xd minus = x;
      plus(i, n) += step;
      minus(i, n) -= step;
      const Eigen::Matrix3Xd slope =
          (body_.InternalForce(plus) - body_.InternalForce(minus)) / (2.0 * step);
      const Eigen::VectorXd column = K.col(3 * n + i);
      const Eigen::Map<const Eigen::VectorXd> stacked(slope.data(), slope.size());
      EXPECT_LT((column + stacked).cwiseAbs().maxCoeff(), 1e-5 * largest);
    }
  }
}

TEST_P(ElasticBodyTest, StiffnessIsSymmetricAndSemiDefiniteAtAnyDeformation) {
  const Eigen::MatrixXd K(body_.Stiffness(Perturbed(3e-3)));
  EXPECT_LT((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-10 * K.cwiseAbs().maxCoeff());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, Eigen::EigenvaluesOnly);
  EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-10 * solver.eigenvalues().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(All, ElasticBodyTest,
                         testing::Combine(testing::Bool(),
                                          testing::Values(MaterialModel::kCorotational,
                                                          MaterialModel::kNeoHookean)),
                         [](const auto& info) {
                           const bool neo_hookean =
                               std::get<1>(info.param) == MaterialModel::kNeoHookean;
                           return std::string(std::get<0>(info.param) ? "Quadratic" : "Linear") +
                                  (neo_hookean ? "NeoHookean" : "Corotational");
                         });

}  // namespace
}  // namespace vacuum_gripper_sim
