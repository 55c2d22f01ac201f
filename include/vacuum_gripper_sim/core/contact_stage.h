#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/contact.h"
#include "vacuum_gripper_sim/core/delassus_operator.h"
#include "vacuum_gripper_sim/core/implicit_euler.h"
#include "vacuum_gripper_sim/core/linear_solver.h"
#include "vacuum_gripper_sim/core/mcp_solver.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/rigid_surface.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/// End of a step under one pressure load.
struct ContactSolution {
  Eigen::VectorXd dv_f;          ///< Velocity change of the free nodes, 3 #free. [m/s]
  Eigen::Matrix3Xd x_W;          ///< Positions of all nodes, 3 by #nodes. [m]
  Eigen::VectorXd lambda;        ///< Normal force on each node, #nodes. [N]
  std::vector<double> distance;  ///< Of each node to the nearest rigid surface, #nodes; +inf for
                                 ///< nodes inside the cup, and without surfaces. [m]
  double max_penetration{0.0};   ///< Over all free surface nodes, >= 0. [m]
  double error{0.0};             ///< Largest penetration, gap under a loaded contact, or way that a
                                 ///< pulling one would let go. [m]
  int num_candidates{0};
  McpStatistics statistics;  ///< Iterations summed, residual of the last solve.
};

/** Items 1 and 3 to 5 of [Bernardin, Sec. III-A] for contacts alone: given the impulse b of the
 free motion and the load of the cavity's pressure, finds the contact forces and the motion.

 Free motion, load and contacts share one solve with A = P^T L L^T P: y = L^-1 P (b + h load) gives
 the gaps, the forces add h Y lambda to it, and the second half turns the sum into the motion.

 Candidates are the pairs of node and surface that carried a force at the last step, and those that
 would end this one nearer than the alarm distance if the nodes kept their velocities. Every surface
 node is checked after the solve; if some passed a surface, all that came that near join the
 candidates, and gaps are measured anew at the end of the motion:

     delta = gap(x_end) - W lambda,      0 <= delta + W lambda'  perp  lambda' >= 0.

 At the fixed point lambda' = lambda the true gaps are complementary to the forces, also on curved
 surfaces. On planes with the current factorisation a pass is exact for its candidates; with an
 earlier one each pass is refined by LinearSolver::Refine(), the loaded contacts held, and checked
 for forces that pull too. */
class ContactStage {
 public:
  /** @param surface_nodes Nodes of the cup's surface, ascending. The clamped ones are measured, but
     never in contact: the mount's motion is prescribed. All references must outlive this. */
  ContactStage(const ImplicitEuler& system, LinearSolver* solver, std::vector<int> surface_nodes,
               const ContactParameters& parameters);

  /** Starts a step; forgets the last one's candidates unless its factorisation stays.
   @param x,v State at the step's start, 3 by #nodes. @param b Right-hand side of the free motion
   A dv = b, 3 #free. [N s] @param dv_c Of the clamped nodes, 3 by #clamped. @param h Time step. [s]
 */
  void Begin(const std::vector<RigidSurface>& surfaces, const Eigen::Matrix3Xd& x,
             const Eigen::Matrix3Xd& v, const Eigen::VectorXd& b, const Eigen::Matrix3Xd& dv_c,
             double h);

  /** Solves the contacts under a load; may be called several times a step.
   @param load Force on every node, 3 by #nodes. [N]
   @param[out] solution
   @param[in,out] timings Adds to free_motion, narrow_phase, delassus, solve and correction.
   @returns false if A is not positive definite. */
  bool Solve(const Eigen::Matrix3Xd& load, ContactSolution* solution, StepTimings* timings);

  /// Forgets the warm start, as after a reset.
  void ForgetForces();

 private:
  /// A row of H_c with its unknown.
  struct Candidate {
    Contact contact;
    double force{0.0};    ///< lambda; before a solve its warm start. [N]
    double applied{0.0};  ///< The force that led to where the gap was measured. [N]
  };

  void FindCandidates();
  Eigen::Matrix3Xd EndPositions(const Eigen::VectorXd& dv_f) const;
  void AddCandidates(const std::vector<Contact>& contacts);
  template <typename Measure>
  void MeasureCandidates(const Measure& measure);
  void UpdateDelassus(StepTimings* timings);
  void SolveCandidates(Eigen::VectorXd* y, ContactSolution* solution, StepTimings* timings);
  bool SolveWithFactorization(const Eigen::VectorXd& impulse, ContactSolution* solution,
                              StepTimings* timings);
  bool Refine(const Eigen::VectorXd& impulse, ContactSolution* solution);
  Eigen::VectorXd WithAppliedForces(Eigen::VectorXd impulse) const;
  void MeasureEnd(ContactSolution* solution) const;
  void Report(ContactSolution* solution) const;
  std::size_t PairIndex(const Contact& contact) const;

  const ImplicitEuler* system_;
  LinearSolver* solver_;
  std::vector<int> surface_nodes_;
  std::vector<int> contact_nodes_;  // those of them that are free
  ContactParameters parameters_;

  // Of the current step.
  const std::vector<RigidSurface>* surfaces_{nullptr};
  Eigen::Matrix3Xd x0_, v0_, dv_c_;
  Eigen::VectorXd b_;
  double h_{0.0};
  NarrowPhase narrow_phase_;

  // Of the current factorisation.
  static constexpr int kNoFactorization = -1;
  int candidates_of_{kNoFactorization};  // its generation
  std::vector<Candidate> candidates_;
  std::vector<bool> is_candidate_;  // by pair
  DelassusOperator delassus_;       // of the first candidates or of all

  std::vector<double> warm_starts_;  // by pair [N]
};

}  // namespace vacuum_gripper_sim
