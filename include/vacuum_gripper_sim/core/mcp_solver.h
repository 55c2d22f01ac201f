#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/contact_factor.h"
#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

/// How a contact solve went. Not converging is data: the caller decides.
struct McpStatistics {
  bool converged{true};  ///< residual <= tolerance
  int iterations{0};     ///< Sweeps, or linear systems solved.
  double residual{0.0};  ///< max_i |min(delta_i, lambda_i W_ii)|, 0 at a solution. [m]
};

/** Solves the contact part of the mixed complementarity problem of [Bernardin, Sec. III-C], the
 pressure being known and part of delta:

     delta_end = delta + W lambda,   0 <= delta_end  perp  lambda >= 0.

 kGaussSeidel: projected Gauss-Seidel with over-relaxation, projected again after relaxing
 ([Duriez 2006] without friction; the paper's choice, with 1e-9 and 100 sweeps).
 kActiveSet: a primal-dual active set, i.e. a semi-smooth Newton method ([Hintermueller 2003]):
 solve for the forces of the assumed contacts, drop those that pull, add those that penetrate.
 Should the number of violations not fall for some changes in a row, the rule of the largest index
 takes over
 ([Judice 1994]), which cannot cycle; so it ends for every positive definite W.

 [Duriez 2006] C. Duriez et al., "Realistic haptic rendering of interacting deformable objects in
   virtual environments", IEEE TVCG 12(1).
 [Hintermueller 2003] M. Hintermueller, K. Ito, K. Kunisch, "The primal-dual active set strategy as
 a semismooth Newton method", SIAM J. Optim. 13(3). [Judice 1994] J. J. Judice, F. M. Pires, "A
 block principal pivoting algorithm for large-scale strictly monotone linear complementarity
 problems", Comput. Oper. Res. 21(5). */
class McpSolver {
 public:
  /** @param W     Delassus operator, n by n, symmetric, positive diagonal; may be semi-definite.
       [m/N]
   @param delta  Gaps without contact forces, n. [m]
   @param[in,out] lambda On entry the warm start (zeros: cold), on exit the contact forces, n. [N]
   @throws std::invalid_argument if the sizes disagree. */
  McpStatistics Solve(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                      const ContactParameters& parameters, Eigen::VectorXd* lambda);

 private:
  McpStatistics SolveByGaussSeidel(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                                   const ContactParameters& parameters, Eigen::VectorXd* lambda);
  McpStatistics SolveByActiveSet(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                                 const ContactParameters& parameters, Eigen::VectorXd* lambda);
  void SetForcesOfActive(const Eigen::MatrixXd& W, const Eigen::VectorXd& delta,
                         Eigen::VectorXd* lambda);

  Eigen::VectorXd delta_end_;  // m
  // Of the active set.
  std::vector<bool> is_active_;
  std::vector<Eigen::Index> active_, violations_;
  ContactFactor factor_;
  Eigen::VectorXd forces_;  // N
};

}  // namespace vacuum_gripper_sim
