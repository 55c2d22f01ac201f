#include "vacuum_gripper_sim/core/material_model.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <random>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

constexpr double kYoung = 338000.0;  // Pa

LameConstants Constants(double poisson_ratio) { return Lame({kYoung, poisson_ratio, 1080.0}); }

Eigen::Matrix3d RandomRotation(std::mt19937* random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(*random), normal(*random), normal(*random), normal(*random))
      .normalized()
      .toRotationMatrix();
}

/// Rotated frames around small and large stretches, flat and inverted ones.
std::vector<Eigen::Matrix3d> Deformations() {
  const std::vector<Eigen::Vector3d> stretches = {
      {1.0, 1.0, 1.0},  {1.1, 0.98, 0.93},   {0.6, 0.7, 0.8},    {3.0, 0.6, 0.55},
      {4.0, 5.0, 6.0},  {1.2, 0.9, 0.02},    {1.2, 0.9, -0.02},  {1.0, 1.0, -1.0},
      {0.4, 0.3, -2.5}, {-0.5, -0.7, -1.3},  {1.0, 0.05, -0.04}, {0.9, 1.0, 0.999999},
      {2.0, 2.0, 0.25}, {0.01, 0.02, 0.015}, {1.3, 1.3, 1.3},    {1.0, 0.0, 0.0}};
  std::mt19937 random(3);
  std::vector<Eigen::Matrix3d> deformations;
  for (const Eigen::Vector3d& stretch : stretches) {
    deformations.push_back(stretch.asDiagonal());
    for (int i = 0; i < 4; ++i) {
      deformations.push_back(RandomRotation(&random) * stretch.asDiagonal() *
                             RandomRotation(&random));
    }
  }
  return deformations;
}

Matrix9d NeoHookeanTangent(const NeoHookeanLaw& law, const Eigen::Matrix3d& F) {
  Matrix9d tangent;
  law.Stress(F, &tangent);
  return tangent;
}

/// dP/dF by central differences; exact but for rounding, P is a polynomial of degree 5.
Matrix9d Hessian(const NeoHookeanLaw& law, const Eigen::Matrix3d& F) {
  const double step = 1e-5;
  Matrix9d hessian;
  for (int k = 0; k < 9; ++k) {
    Eigen::Matrix3d plus = F;
    Eigen::Matrix3d minus = F;
    plus.data()[k] += step;
    minus.data()[k] -= step;
    const Eigen::Matrix3d slope =
        (law.Stress(plus, nullptr) - law.Stress(minus, nullptr)) / (2.0 * step);
    hessian.col(k) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(slope.data());
  }
  return 0.5 * (hessian + hessian.transpose());
}

TEST(Lame, FollowsFromYoungAndPoisson) {
  const LameConstants lame = Constants(0.25);
  EXPECT_NEAR(lame.mu, kYoung / 2.5, 1e-9);
  EXPECT_NEAR(lame.lambda, lame.mu, 1e-9);  // equal at nu = 1/4
}

TEST(MaterialLaw, FollowsTheModel) {
  Material material;
  EXPECT_TRUE(std::holds_alternative<CorotationalLaw>(MakeMaterialLaw(material)));
  material.model = MaterialModel::kNeoHookean;
  EXPECT_TRUE(std::holds_alternative<NeoHookeanLaw>(MakeMaterialLaw(material)));
}

template <typename Law>
class AnyLaw : public testing::Test {
 protected:
  const Law law_{Constants(0.45)};
};
using Laws = testing::Types<CorotationalLaw, NeoHookeanLaw>;
TYPED_TEST_SUITE(AnyLaw, Laws);

TYPED_TEST(AnyLaw, RestIsFreeOfStressWhateverItsRotation) {
  std::mt19937 random(5);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Matrix3d R = RandomRotation(&random);
    EXPECT_LT(this->law_.Stress(R, nullptr).norm(), 1e-13 * this->law_.lame().lambda);
    EXPECT_NEAR(this->law_.EnergyDensity(R), 0.0, 1e-13 * this->law_.lame().lambda);
  }
}

TYPED_TEST(AnyLaw, StressIsTheGradientOfTheEnergy) {
  // Where F is moderately far from flat, so that the co-rotational energy is smooth.
  std::mt19937 random(11);
  for (const Eigen::Vector3d& stretch :
       {Eigen::Vector3d(1.1, 0.95, 0.8), Eigen::Vector3d(2.0, 0.6, 1.4),
        Eigen::Vector3d(1.1, 0.9, -0.3), Eigen::Vector3d(1.4, 1.7, -0.9)}) {
    const Eigen::Matrix3d F =
        RandomRotation(&random) * stretch.asDiagonal() * RandomRotation(&random);
    const Eigen::Matrix3d P = this->law_.Stress(F, nullptr);
    const double step = 1e-6;
    for (int k = 0; k < 9; ++k) {
      Eigen::Matrix3d plus = F;
      Eigen::Matrix3d minus = F;
      plus.data()[k] += step;
      minus.data()[k] -= step;
      const double slope =
          (this->law_.EnergyDensity(plus) - this->law_.EnergyDensity(minus)) / (2.0 * step);
      EXPECT_NEAR(P.data()[k], slope, 1e-7 * P.norm());
    }
  }
}

// Turning the body turns its stress; turning the material first changes nothing but its axes.
TYPED_TEST(AnyLaw, IsObjectiveAndIsotropic) {
  std::mt19937 random(17);
  for (const Eigen::Vector3d& stretch :
       {Eigen::Vector3d(1.1, 0.95, 0.8), Eigen::Vector3d(1.3, 0.8, -0.4)}) {
    const Eigen::Matrix3d F =
        RandomRotation(&random) * stretch.asDiagonal() * RandomRotation(&random);
    const Eigen::Matrix3d R = RandomRotation(&random);
    const Eigen::Matrix3d P = this->law_.Stress(F, nullptr);
    EXPECT_LT((this->law_.Stress(R * F, nullptr) - R * P).norm(), 1e-11 * P.norm());
    EXPECT_LT((this->law_.Stress(F * R, nullptr) - P * R).norm(), 1e-11 * P.norm());
    EXPECT_NEAR(this->law_.EnergyDensity(R * F * R), this->law_.EnergyDensity(F),
                1e-11 * this->law_.EnergyDensity(F));
  }
}

// Small strains: sigma = lambda tr(eps) I + 2 mu eps, with the constants of E and nu themselves.
TYPED_TEST(AnyLaw, LinearisesToHookesLaw) {
  Eigen::Matrix3d eps;
  eps << 2.0, 0.3, -0.2, 0.3, -1.0, 0.1, -0.2, 0.1, 0.5;
  eps *= 1e-7;
  const LameConstants lame = this->law_.lame();
  const Eigen::Matrix3d sigma =
      lame.lambda * eps.trace() * Eigen::Matrix3d::Identity() + 2.0 * lame.mu * eps;
  const Eigen::Matrix3d P = this->law_.Stress(Eigen::Matrix3d::Identity() + eps, nullptr);
  EXPECT_LT((P - sigma).norm(), 1e-5 * sigma.norm());
}

TEST(NeoHookean, TangentAtRestIsThatOfHookesLaw) {
  const NeoHookeanLaw law(Constants(0.45));
  Matrix9d hooke;
  for (int k = 0; k < 9; ++k) {
    Eigen::Matrix3d dF = Eigen::Matrix3d::Zero();
    dF.data()[k] = 1.0;
    const Eigen::Matrix3d dP = law.lame().lambda * dF.trace() * Eigen::Matrix3d::Identity() +
                               law.lame().mu * (dF + dF.transpose());
    hooke.col(k) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(dP.data());
  }
  EXPECT_LT((NeoHookeanTangent(law, Eigen::Matrix3d::Identity()) - hooke).norm(),
            1e-12 * hooke.norm());
}

TEST(NeoHookean, TangentIsSymmetricAndSemiDefinite) {
  for (const double poisson_ratio : {0.0, 0.3, 0.45, 0.499}) {
    const NeoHookeanLaw law(Constants(poisson_ratio));
    for (const Eigen::Matrix3d& F : Deformations()) {
      const Matrix9d tangent = NeoHookeanTangent(law, F);
      EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-13 * tangent.norm());
      const Eigen::SelfAdjointEigenSolver<Matrix9d> solver(tangent);
      EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-8 * solver.eigenvalues().maxCoeff())
          << "nu = " << poisson_ratio << ", F =\n"
          << F;
    }
  }
}

// The exact tangent where that is semi-definite; elsewhere its negative eigenvalues change sign and
// nothing else changes.
TEST(NeoHookean, TangentIsTheHessianWithAbsoluteEigenvalues) {
  int num_definite = 0;
  int num_indefinite = 0;
  for (const double poisson_ratio : {0.3, 0.45}) {
    const NeoHookeanLaw law(Constants(poisson_ratio));
    for (const Eigen::Matrix3d& F : Deformations()) {
      const Matrix9d hessian = Hessian(law, F);
      const Eigen::SelfAdjointEigenSolver<Matrix9d> solver(hessian);
      const Matrix9d absolute = solver.eigenvectors() *
                                solver.eigenvalues().cwiseAbs().asDiagonal() *
                                solver.eigenvectors().transpose();
      const bool definite = solver.eigenvalues().minCoeff() > -1e-8 * hessian.norm();
      (definite ? num_definite : num_indefinite)++;
      EXPECT_LT((NeoHookeanTangent(law, F) - (definite ? hessian : absolute)).norm(),
                1e-7 * hessian.norm())
          << "nu = " << poisson_ratio << ", F =\n"
          << F;
    }
  }
  EXPECT_GE(num_definite, 10);
  EXPECT_GE(num_indefinite, 10);
}

// Pulled along x to the stretch a, free on its sides: P_yy = 0 gives their stretch b by
// a b^2 = 1 + mu (1 - 1/a) / kappa, and then P_xx = mu (a - b^2 / a).
TEST(NeoHookean, UniaxialTension) {
  for (const double poisson_ratio : {0.3, 0.45, 0.499}) {
    const NeoHookeanLaw law(Constants(poisson_ratio));
    const double mu = law.lame().mu;
    const double kappa = law.lame().lambda + mu;
    for (const double a : {0.7, 0.999, 1.001, 1.5, 3.0}) {
      const double b_squared = (1.0 + mu * (1.0 - 1.0 / a) / kappa) / a;
      const double b = std::sqrt(b_squared);
      const Eigen::Matrix3d P =
          law.Stress(Eigen::Vector3d(a, b, b).asDiagonal().toDenseMatrix(), nullptr);
      const Eigen::Vector3d expected(mu * (a - b_squared / a), 0.0, 0.0);
      EXPECT_LT((P - expected.asDiagonal().toDenseMatrix()).norm(), 1e-12 * kappa) << a;
      if (std::abs(a - 1.0) < 0.01) {
        EXPECT_NEAR(P(0, 0), kYoung * (a - 1.0), 0.003 * std::abs(P(0, 0)));
      }
    }
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
