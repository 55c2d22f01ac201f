#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "vacuum_gripper_sim/core/contact.h"
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
  double error{0.0};             ///< Largest penetration, or gap under a loaded contact. [m]
  int num_candidates{0};
  McpStatistics statistics;  ///< Iterations summed, residual of the last solve.
};

/** Items 3 to 5 of [Bernardin, Sec. III-A] for contacts alone: given the free motion and the load
 of the cavity's pressure, finds the contact forces and the corrected motion.

 Candidates are the pairs of node and surface that start the step nearer than the alarm distance.
 Every surface node is checked after the solve; those that passed a surface join the candidates, and
 gaps are measured anew at the end of the motion:

     delta = gap(x_end) - W lambda,      0 <= delta + W lambda'  perp  lambda' >= 0.

 At the fixed point lambda' = lambda the true gaps are complementary to the forces, also on curved
 surfaces and with a W from an earlier factorisation. On planes with the current factorisation the
 first pass is exact. */
class ContactStage {
 public:
  /** @param surface_nodes Nodes of the cup's surface, ascending. The clamped ones are measured, but
     never in contact: the mount's motion is prescribed. All references must outlive this. */
  ContactStage(const ImplicitEuler& system, LinearSolver* solver, std::vector<int> surface_nodes,
               const ContactParameters& parameters);

  /** Starts a step from its free motion; forgets the candidates of the last one.
   @param x,v State at the step's start, 3 by #nodes. @param dv_f Free motion, 3 #free.
   @param dv_c Of the clamped nodes, 3 by #clamped. @param h Time step. [s] */
  void Begin(const std::vector<RigidSurface>& surfaces, const Eigen::Matrix3Xd& x,
             const Eigen::Matrix3Xd& v, const Eigen::VectorXd& dv_f, const Eigen::Matrix3Xd& dv_c,
             double h);

  /** Solves the contacts under a load; may be called several times a step.
   @param load Force on every node, 3 by #nodes. [N]
   @param[out] solution
   @param[in,out] timings Adds to narrow_phase, delassus, solve and correction.
   @returns false if a linear solve failed. */
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

  Eigen::Matrix3Xd EndPositions(const Eigen::VectorXd& dv_f) const;
  void AddCandidates(const std::vector<Contact>& contacts);
  bool IsCandidate(const Contact& contact) const;
  template <typename Measure>
  void MeasureCandidates(const Measure& measure);
  void UpdateDelassus(StepTimings* timings);
  void SolveCandidates(ContactSolution* solution, StepTimings* timings);
  bool Correct(const Eigen::VectorXd& dv_loaded, ContactSolution* solution, StepTimings* timings);
  void MeasureEnd(ContactSolution* solution) const;
  void Report(ContactSolution* solution) const;
  double& WarmStart(const Contact& contact);

  const ImplicitEuler* system_;
  LinearSolver* solver_;
  std::vector<int> surface_nodes_;
  std::vector<int> contact_nodes_;  // those of them that are free
  ContactParameters parameters_;

  // Of the current step.
  const std::vector<RigidSurface>* surfaces_{nullptr};
  Eigen::Matrix3Xd x0_, v0_, dv_c_;
  Eigen::VectorXd dv_free_;
  double h_{0.0};
  NarrowPhase narrow_phase_;
  std::vector<Candidate> candidates_;  // nodes ascending
  bool delassus_outdated_{true};
  Eigen::SparseMatrix<double> H_transposed_;  // 3 #free by #candidates
  Eigen::MatrixXd W_;                         // [m/N]

  std::vector<double> warm_starts_;  // of (node, surface), node-major [N]
};

}  // namespace vacuum_gripper_sim
