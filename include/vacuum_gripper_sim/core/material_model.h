#pragma once

#include <Eigen/Core>
#include <variant>

#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

/// Lame's constants of an isotropic material. [Pa]
struct LameConstants {
  double lambda{0.0};
  double mu{0.0};
};
LameConstants Lame(const Material& material);

/// A linear map from 3 by 3 to 3 by 3 matrices; entry (i, J) of a matrix has the index i + 3 J.
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/** Linear elasticity in a rotated frame. With F = dx/dX and R the rotation nearest to F,

     Psi = mu |F - R|^2 + lambda/2 tr(R^T F - I)^2                (energy density)  [J/m^3]
     P   = 2 mu (F - R) + lambda tr(R^T F - I) R                  (P = dPsi/dF)     [Pa]
     dP  = lambda (R : dF) R + mu (dF + R dF^T R)                 (tangent, R held) [Pa]

 ([Mueller 2004], the paper's reference [3]). The tangent is that of linear elasticity in the
 rotated frame, symmetric and positive semi-definite whatever the deformation, and exact at every
 rigidly moved rest state.

 [Mueller 2004] M. Mueller, M. Gross, "Interactive virtual materials", Graphics Interface 2004. */
class CorotationalLaw {
 public:
  /// The tangent: only its rotation changes.
  struct Tangent {
    Eigen::Matrix3d R;
  };

  explicit CorotationalLaw(const LameConstants& lame) : lame_(lame) {}
  const LameConstants& lame() const { return lame_; }

  double EnergyDensity(const Eigen::Matrix3d& F) const;
  /// P at F. @param[out] tangent Only written when not null.
  Eigen::Matrix3d Stress(const Eigen::Matrix3d& F, Tangent* tangent) const;

 private:
  LameConstants lame_;
};

/** The stable neo-Hookean law of [Smith 2018, Sec. 3.4]. With J = det F, C = dJ/dF the cofactors of
 F and kappa = lambda + mu,

     Psi = mu/2 (|F|^2 - 3) - mu (J - 1) + kappa/2 (J - 1)^2      (energy density)  [J/m^3]
     P   = mu F + (kappa (J - 1) - mu) C                          (P = dPsi/dF)     [Pa]
     dP  = mu dF + kappa (C : dF) C + (kappa (J - 1) - mu) dC     (exact tangent)   [Pa]

 It is Hooke's law with Lame's lambda and mu at rest, a polynomial in F and so finite through
 inversion, and has no local minimum but the rest state's rotations.

 The exact tangent is indefinite wherever the material is compressed. That of this class has the
 absolute values of its eigenvalues [Chen 2024], mode by mode in the principal frame
 F = U diag(s) V^T of [Smith 2018, Sec. 4]: for the three pairs of off-diagonal entries these are
 mu -/+ t_k (twist and flip) with t_k = (mu - kappa (J - 1)) s_k; the diagonal entries leave a 3 by
 3 matrix. Negative eigenvalues set to zero instead leave directions without stiffness while the
 volume is off by mu / kappa: at nu = 0.499 a single linearised step per time step then runs away.

 Against a neo-Hookean law of the split form mu/2 (J^(-2/3) |F|^2 - 3) + K/2 (J - 1)^2 only terms in
 J - 1 differ; both tend to the same incompressible law.

 [Smith 2018] B. Smith, F. de Goes, T. Kim, "Stable neo-Hookean flesh simulation", ACM TOG 37(2).
 [Chen 2024] H. Chen, H.-T. D. Liu, D. I. W. Levin, C. Zheng, A. Jacobson, "Stabler neo-Hookean
   simulation: absolute eigenvalue filtering for projected Newton", SIGGRAPH 2024. */
class NeoHookeanLaw {
 public:
  using Tangent = Matrix9d;

  explicit NeoHookeanLaw(const LameConstants& lame) : lame_(lame) {}
  const LameConstants& lame() const { return lame_; }

  double EnergyDensity(const Eigen::Matrix3d& F) const;
  /// P at F. @param[out] tangent With eigenvalues >= 0; only written when not null.
  Eigen::Matrix3d Stress(const Eigen::Matrix3d& F, Tangent* tangent) const;

 private:
  LameConstants lame_;
};

using MaterialLaw = std::variant<CorotationalLaw, NeoHookeanLaw>;
MaterialLaw MakeMaterialLaw(const Material& material);

}  // namespace vacuum_gripper_sim
