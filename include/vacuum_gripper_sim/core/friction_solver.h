#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/contact_compliance.h"
#include "vacuum_gripper_sim/core/linearized_contacts.h"
#include "vacuum_gripper_sim/core/mcp_solver.h"
#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

/// Where a contact's rows are in W: its normal, then, with friction, two tangents across it.
struct ContactRows {
  Eigen::Index normal{0};
  double friction{0.0};  ///< mu. [-] 0: there are no tangents.

  bool has_tangents() const { return friction > 0.0; }
  Eigen::Index size() const { return has_tangents() ? 3 : 1; }
  Eigen::Index tangent() const { return normal + 1; }  ///< The first of two.
};

/** Solves contacts, those with friction by Coulomb's law, coupled through W in all directions:

     delta_end = delta + W lambda,
     0 <= delta_n  perp  lambda_n >= 0,
     |lambda_t| <= mu lambda_n;  where it slides, lambda_t = -mu lambda_n delta_t / |delta_t|,

 where delta_t is the slip during the step. The cone is exact: no pyramid, and a sliding contact
 does not rise from its surface.

 Groups that nothing couples are solved one by one, those without friction by McpSolver;
 coupled ones together:

 kActiveSet: a semi-smooth Newton method on the projections of [Alart 1991],

     lambda_n = max(0, lambda_n - delta_n / W_nn),
     lambda_t = proj(lambda_t - delta_t / W_tt) onto the disc of radius mu lambda_n,

 in the unknowns of closed contacts only, see LinearizedContacts. Where a full step does not lessen
 the residual, it is shortened, and sweeps of Gauss-Seidel, which always lessen it in the end, bring
 the next start.
 kGaussSeidel: contact by contact on the same projections, tangents after the normal.

 [Alart 1991] P. Alart, A. Curnier, "A mixed formulation for frictional contact problems prone to
   Newton like solution methods", Comput. Methods Appl. Mech. Eng. 92(3). */
class FrictionSolver {
 public:
  /** @param delta   Gaps and slips without forces, n. [m]
   @param rows    Of every contact; together they cover W, and each is within a group.
   @param[in,out] lambda On entry the warm start, on exit the forces, n. [N]
   @returns iterations, and the residual: the largest |min(delta_n, W_nn lambda_n)| or distance of
     W_tt lambda_t from its projection. [m] Of groups solved one by one the largest.
   @throws std::invalid_argument if the sizes disagree. */
  McpStatistics Solve(const ContactCompliance& W, const Eigen::VectorXd& delta,
                      const std::vector<ContactRows>& rows, const ContactParameters& parameters,
                      Eigen::VectorXd* lambda);

 private:
  struct ScaledContact {
    ContactRows rows;
    const ContactCompliance::Group* group{nullptr};
    double normal_scale{0.0};   // W_nn [m/N]
    double tangent_scale{0.0};  // mean W_tt [m/N]
  };
  McpStatistics SolveAlone(const ContactCompliance& W, std::size_t group,
                           const Eigen::VectorXd& delta, const std::vector<ContactRows>& rows,
                           const ContactParameters& parameters, Eigen::VectorXd* lambda);
  McpStatistics SolveTogether(const ContactCompliance& W, const Eigen::VectorXd& delta,
                              const std::vector<ContactRows>& rows,
                              const ContactParameters& parameters, Eigen::VectorXd* lambda);
  McpStatistics SolveByGaussSeidel(const ContactParameters& parameters, Eigen::VectorXd* lambda);
  McpStatistics SolveByNewton(const ContactParameters& parameters, Eigen::VectorXd* lambda);
  double FindEnd(const Eigen::VectorXd& lambda);
  double Residual(const Eigen::VectorXd& lambda) const;
  void Sweep(double relaxation, Eigen::VectorXd* lambda);
  void FindNewtonTarget(const Eigen::VectorXd& lambda);

  // Of the contacts that are solved together.
  const ContactCompliance* W_{nullptr};
  const Eigen::VectorXd* delta_{nullptr};
  std::vector<ScaledContact> contacts_;
  Eigen::VectorXd end_;    // gaps and slips under the forces of the moment [m]
  Eigen::VectorXd moved_;  // U^T (changes of the forces) of a sweep

  // Of Newton's method. [N]
  std::vector<Eigen::Index> held_;
  std::vector<SlidingContact> sliding_;
  LinearizedContacts linearized_;
  Eigen::VectorXd target_, start_, best_;

  // Of groups one by one.
  McpSolver without_friction_;
  ContactCompliance alone_;
  std::vector<ContactRows> rows_alone_;
  Eigen::VectorXd delta_alone_, lambda_alone_;
};

}  // namespace vacuum_gripper_sim
