#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "vacuum_gripper_sim/core/background_factorization.h"
#include "vacuum_gripper_sim/core/constraint_operator.h"
#include "vacuum_gripper_sim/core/crew.h"
#include "vacuum_gripper_sim/core/delassus_operator.h"
#include "vacuum_gripper_sim/core/eliminated_columns.h"
#include "vacuum_gripper_sim/core/implicit_euler.h"
#include "vacuum_gripper_sim/core/linearized_contacts.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"
#include "vacuum_gripper_sim/core/system_vector.h"

namespace vacuum_gripper_sim {

/** Keeps a factorisation for the step's symmetric positive definite A, and closes the difference
 where it belongs to an earlier one.

 kDirect factorises every A. The others are ways of [Bernardin, Sec. III-A]: an earlier A's
 factorisation preconditions conjugate gradients, so that the answer depends on their tolerance and
 not on the factorisation's age. kConjugateGradient makes a new one when a step's iterations cost
 more than the average step since, the factorisation's own cost shared among them, and after
 `refactor_interval` steps if they iterate. kAsynchronous has a second thread factorise one A after
 the other, W included, and takes the newest one after every step that iterated; how old that is
 depends on the threads' speed. Where iterations do not end, the step's A is factorised at once, and
 those of the next steps too, the more of them the more often in a row that happens. */
class LinearSolver {
 public:
  /// @param system Its A_ff is the matrix; must outlive this.
  LinearSolver(const LinearSolverParameters& parameters, ImplicitEuler* system);

  /** Takes the system's A as it is now.
   @returns false if A is not positive definite. @throws what the second thread did. */
  bool Compute();
  /// Makes the factorisation that of the last Compute()'s A, or more precise if it is already.
  /// @returns false if A is not positive definite.
  bool Renew();

  /// The newest factorisation: of the last A or of an earlier one.
  const SparseCholesky& factorization() const { return factorization_; }
  /// Tells one factorisation from the next.
  int generation() const { return generation_; }
  /// Hands the A of the last Compute() to the second thread, if there is one and it has nothing to
  /// do, for a factorisation of some step to come and W of contacts. @param columns Theirs, by
  /// piece of A, see ContactColumns. @param h Time step. [s]
  void FactorizeAhead(const std::vector<std::vector<NodeColumn>>& columns, double h);
  /// Would it?
  bool MayFactorizeAhead() const;
  /// W that came along with factorization(), by piece of A, of the contacts that were handed over
  /// last; to be exchanged at will. Nothing if it came without, for the second time, or after the
  /// next FactorizeAhead().
  std::vector<DelassusOperator>* TakePrepared() {
    return prepared_of_ == generation_ ? std::exchange(prepared_, nullptr) : nullptr;
  }

  /// Does factorization() belong to the A of the last Compute(), in full precision?
  bool current() const {
    return factorized_step_ == step_ && factorization_.precision() == Precision::kDouble;
  }

  /// Does it belong to the A of an earlier step?
  bool old() const { return factorized_step_ != step_; }

  /** Finds where to start: the multiple of a guess that comes nearest to the solution of A dv = b
   in the energy norm ([Fischer 1998] with one vector).
   @param constraints Of factorization(); for the bodies' masses.
   @param[in,out] dv Guess; its multiple. @param[in,out] b Impulses; less A dv. [N s]

   [Fischer 1998] P. F. Fischer, "Projection techniques for iterative solution of Ax = b with
   successive right-hand sides", Comput. Methods Appl. Mech. Eng. 163. */
  void Start(const ConstraintOperator& constraints, SystemVector* dv, SystemVector* b);

  /** Solves A dv = b + h H^T lambda where `held` rows keep their gaps and slips and only they
   change their forces: conjugate gradients among the motions that move no held row, preconditioned
   by the factorisation A_0 under the same constraint ([Gould 2001], Algorithms 2.1 and 6.2),

       ( A_0  -h H^T ) (z )   (r)
       ( h H     0   ) (mu) = (0),   r := r + h H^T mu.

   Free bodies take part with M, and J beside H.
   @param b Impulses of the cup and of the bodies. [N s] @param constraints Of factorization().
   @param held Indices of its rows. @param[in,out] dv Motion. [m/s]
   @param[in,out] lambda A force for every row. [N]
   @param slack How many times the tolerance will do.
   @returns false if neither |r| <= slack tolerance max(|b|, ImplicitEuler::ImpulseScale()) is in
   reach of max_iterations, nor a last correction by which nothing moves farther than
   position_tolerance in the step, or less where the residual has shrunk less than corrections have:
   of a correction what is left is A^-1 A_0 - 1 times as much.

   [Gould 2001] N. I. M. Gould, M. E. Hribar, J. Nocedal, "On the solution of equality constrained
   quadratic programming problems arising in optimization", SIAM J. Sci. Comput. 23(4). */
  bool Refine(const SystemVector& b, const ConstraintOperator& constraints,
              const std::vector<Eigen::Index>& held, SystemVector* dv, Eigen::VectorXd* lambda,
              double slack = 1.0);

  /// Threads that share what can be shared of a step.
  Crew& crew() { return crew_; }
  int iterations() const { return iterations_; }          ///< CG, since Compute().
  int factorizations() const { return factorizations_; }  ///< On this thread, since Compute().

 private:
  bool MayTry();
  bool Hopeless(int iterations, double pace, double excess) const;
  bool WornOut() const;
  bool FactorizeWith(Precision precision);
  void Precondition(const ConstraintOperator& constraints, bool any_held, Eigen::VectorXd* lambda);
  bool TakeFromBackground(bool wanted);

  LinearSolverParameters parameters_;
  ImplicitEuler* system_;
  Crew crew_;
  SparseCholesky factorization_;
  bool usable_{false};  // does factorization_ hold a factor?
  int generation_{0};
  std::int64_t step_{0};
  std::int64_t factorized_step_{0};   // whose A factorization_ belongs to
  std::int64_t background_step_{0};   // whose A the second thread has
  std::int64_t iterations_since_{0};  // factorized_step_, without the current step
  int iterations_{0};
  int iterations_before_{0};  // of the step, with factorisations given up since
  int factorizations_{0};
  bool tried_{false};  // to do the last step with an earlier factorisation
  int pause_{0};       // steps without a try, after the last ones in vain
  int pause_left_{0};  // of these
  std::vector<DelassusOperator>* prepared_{nullptr};
  int prepared_of_{0};  // generation
  // Of Refine().
  SystemVector r_, p_, Ap_;  // residual, direction and its product with A
  SystemVector y_, z_;       // of r_ in the preconditioner, half way and at its end
  LinearizedContacts held_;  // of factorization_
  Eigen::VectorXd gap_changes_, mu_;
  std::unique_ptr<BackgroundFactorization> background_;  // kAsynchronous only
};

}  // namespace vacuum_gripper_sim
