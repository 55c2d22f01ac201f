#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "vacuum_gripper_sim/core/constraint_operator.h"
#include "vacuum_gripper_sim/core/contact_columns.h"
#include "vacuum_gripper_sim/core/contact_finder.h"
#include "vacuum_gripper_sim/core/friction_solver.h"
#include "vacuum_gripper_sim/core/implicit_euler.h"
#include "vacuum_gripper_sim/core/linear_solver.h"
#include "vacuum_gripper_sim/core/mcp_solver.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/pressure_on_objects.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/step_result.h"
#include "vacuum_gripper_sim/core/system_vector.h"

namespace vacuum_gripper_sim {

/// End of a step under one pressure load.
struct ContactSolution {
  SystemVector dv;                  ///< Velocity change of free nodes and bodies. [m/s], [rad/s]
  Eigen::Matrix3Xd x_W;             ///< Positions of all nodes, 3 by #nodes. [m]
  Eigen::VectorXd lambda;           ///< Normal force on each node, #nodes. [N]
  Eigen::VectorXd on_objects;       ///< Of that what is between cup and objects. [N]
  Eigen::Matrix3Xd forces_W;        ///< Of the contacts on each node, 3 by #nodes. [N]
  std::vector<double> distance;     ///< Of each node to the nearest rigid surface, #nodes; +inf for
                                    ///< nodes inside the cup, and without surfaces. [m]
  std::vector<ObjectLoad> objects;  ///< Contacts with the cup and its pressure, by object.
  double contact_force{0.0};        ///< Sum of the normal forces of objects on the cup. [N]
  double fold_force{0.0};           ///< Sum of the normal forces where the cup's folds meet. [N]
  double friction_force{0.0};       ///< Sum of the tangential forces on the cup, their size. [N]
  double max_penetration{0.0};      ///< Over all free surface nodes, >= 0. [m]
  double error{0.0};                ///< Largest penetration, gap under a loaded contact, or way
                                    ///< that a pulling one would let go. [m]
  bool settled{false};              ///< Was nothing left to correct?
  int num_candidates{0};
  std::vector<int> contact_nodes;  ///< A node of the cup for each contact that carries load.
  McpStatistics statistics;        ///< Iterations summed, residual of the last solve.
};

/** Items 1 and 3 to 5 of [Bernardin, Sec. III-A] for contacts alone: given the impulse b of the
 free motion and the load of the cavity's pressure, finds the contact forces and the motion of the
 cup and of the free bodies, with friction where the surfaces have some.

 Free motion, load and contacts share one solve with A = P^T L L^T P: y = L^-1 P (b + h load) gives
 the gaps, the forces add h Y lambda to it, and the second half turns the sum into the motion.

 Candidates are the pairs of points and surfaces that carried a force at the last step, and those
 that would end this one nearer than the alarm distance if the nodes kept their velocities. Every
 surface node is checked after the solve; if some passed a surface, all that came that near join the
 candidates, and gaps are measured anew at the end of the motion:

     delta = gap(x_end) - W lambda,      0 <= delta + W lambda'  perp  lambda' >= 0.

 At the fixed point lambda' = lambda the true gaps are complementary to the forces, also on curved
 surfaces and for bodies that turn. On planes with the current factorisation a pass is exact for its
 candidates; with an earlier one each pass is refined by LinearSolver::Refine(), the loaded contacts
 held, and checked for forces that pull too. Friction and free bodies want the current one. */
class ContactStage {
 public:
  /** @param mesh The cup at rest. @param surface_nodes Nodes of the cup's surface, ascending. The
     clamped ones are measured, but never in contact: the mount's motion is prescribed. All
     references must outlive this. */
  ContactStage(const TetMesh& mesh, const ImplicitEuler& system, LinearSolver* solver,
               std::vector<int> surface_nodes, const ContactParameters& parameters);

  /** Starts a step; forgets the last one's candidates unless its factorisation stays.
   @param world Must outlive the step. @param x,v State at the step's start, 3 by #nodes.
   @param b Right-hand side of the free motion A dv = b, 3 #free. [N s]
   @param dv_c Of the clamped nodes, 3 by #clamped.
   @param b_bodies Of the free bodies' motion, 6 #bodies, see RigidWorld::FreeImpulse().
   @param h Time step. [s] */
  void Begin(const RigidWorld& world, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v,
             const Eigen::VectorXd& b, const Eigen::Matrix3Xd& dv_c,
             const Eigen::VectorXd& b_bodies, double h);

  /// How exactly motion and forces of the loaded contacts are found: kFull to
  /// LinearSolverParameters::tolerance, kTrial to kTrialSlack times that, for an end of the step
  /// that is on the way to another.
  enum class Accuracy { kTrial, kFull };
  static constexpr double kTrialSlack = 100.0;

  /** Solves the contacts under a load; may be called several times a step.
   @param load Force on every node, 3 by #nodes. [N] @param accuracy How exactly.
   @param[out] solution
   @param[in,out] timings Adds to free_motion, narrow_phase, delassus, solve and correction.
   @returns false if A is not positive definite. */
  bool Solve(const Eigen::Matrix3Xd& load, Accuracy accuracy, ContactSolution* solution,
             StepTimings* timings);

  /// Of a point to the surface nearest to it, where the last Solve() left them; +inf without any.
  /// @param p_W World. [m]
  double Distance(const Eigen::Vector3d& p_W) const;

  /// The surface that is nearest to a surface node at the step's start, of the world's.
  /// @pre There is one.
  int NearestSurface(int node) const { return finder_.NearestSurface(node); }

  /// Forgets the warm start, as after a step that was undone.
  void ForgetForces();
  /// Forgets what was seen of the objects, too, as when there are others or the cup is elsewhere.
  void ForgetWorld();

 private:
  /// A contact with its unknown: the force along normal and tangents, see ConstraintOperator.
  struct Candidate {
    Contact contact;
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};    ///< Before a solve its warm start. [N]
    Eigen::Vector3d applied{Eigen::Vector3d::Zero()};  ///< The force that led to where the gap was
                                                       ///< measured. [N]
  };
  void FindCandidates();
  void StartAfresh();
  void LookAhead();
  void FindEnd(const SystemVector& dv, TrialEnd* end);
  void AddCandidates(const std::vector<Contact>& contacts);
  bool IsCandidate(std::uint64_t key) const;
  template <typename Measure>
  void MeasureCandidates(const Measure& measure);
  void UpdateOperator(StepTimings* timings);
  void SolveCandidates(ContactSolution* solution, StepTimings* timings);
  bool SolveWithFactorization(ContactSolution* solution, StepTimings* timings);
  void Start(ContactSolution* solution, StepTimings* timings);
  bool Refine(ContactSolution* solution);
  const Eigen::VectorXd& Stack(Eigen::Vector3d Candidate::*values, Eigen::VectorXd* stacked) const;
  void SetForces(const Eigen::VectorXd& lambda);
  void MeasureEnd(const TrialEnd& end, ContactSolution* solution);
  void Report(ContactSolution* solution) const;

  const ImplicitEuler* system_;
  LinearSolver* solver_;
  std::vector<int> surface_nodes_;
  ContactParameters parameters_;

  // Of the current step.
  const RigidWorld* world_{nullptr};
  Eigen::Matrix3Xd x0_, v0_, dv_c_;
  Eigen::VectorXd b_, b_bodies_;
  double h_{0.0};
  Accuracy accuracy_{Accuracy::kFull};  // of the solve at hand
  ContactFinder finder_;
  std::vector<ObjectLoad> pressure_on_;     // of the current load, by object
  std::vector<RigidSurface> surfaces_end_;  // of the current trial, if bodies move
  SystemVector impulse_;                    // of free motion and load
  SystemVector y_;                          // what a pass adds to the motion, half solved for
  SystemVector last_motion_;                // of the last solve, maybe of the last step
  TrialEnd coasting_, end_;                 // without a change of velocity, and of the trial
  // Kept for their memory.
  SystemVector none_, with_forces_;
  Eigen::VectorXd dv_of_pass_;        // of the cup [m/s]
  Eigen::VectorXd delta_;             // gaps and slips without further forces [m]
  Eigen::VectorXd lambda_, applied_;  // [N]
  std::vector<Contact> selected_, contacts_;
  std::vector<Eigen::Index> held_;
  std::vector<double> nearest_;  // [m]

  // Of the current factorisation.
  static constexpr int kNoFactorization = -1;
  int candidates_of_{kNoFactorization};  // its generation
  std::vector<Candidate> candidates_;
  std::vector<std::uint64_t> candidate_keys_;  // ascending
  ConstraintOperator operator_;                // of the first candidates or of all
  std::vector<Contact> expected_;              // when the second thread's factorisation is done
  ContactColumns expected_columns_;
  FrictionSolver contact_solver_;

  /// Forces of the last step, by key: the normal one and the others in world axes, as what is
  /// across a normal may change from step to step. [N]
  struct WarmStart {
    double normal{0.0};
    Eigen::Vector3d tangential_W{Eigen::Vector3d::Zero()};
  };
  std::unordered_map<std::uint64_t, WarmStart> warm_starts_;
};

}  // namespace vacuum_gripper_sim
