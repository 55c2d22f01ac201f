#include "vacuum_gripper_sim/core/linear_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Steps without a try, at most.
constexpr int kLongestPause = 7;

}  // namespace

LinearSolver::LinearSolver(const LinearSolverParameters& parameters, ImplicitEuler* system)
    : parameters_(parameters), system_(system), crew_(parameters.threads) {
  factorization_.Analyze(system->matrix().pattern(), &crew_);
  if (parameters.method == LinearSolverMethod::kAsynchronous) {
    background_ = std::make_unique<BackgroundFactorization>(factorization_, system->matrix(),
                                                            parameters.precision);
  }
}

bool LinearSolver::Compute() {
  const bool has_iterated = iterations_ > 0;
  const bool old = step_ - factorized_step_ + 1 >= parameters_.refactor_interval;
  const bool due = (has_iterated && old) || WornOut();
  bool good = usable_ && MayTry();
  ++step_;
  iterations_since_ += iterations_;
  iterations_ = 0;
  iterations_before_ = 0;
  factorizations_ = 0;

  switch (parameters_.method) {
    case LinearSolverMethod::kDirect:
      good = false;
      break;
    case LinearSolverMethod::kConjugateGradient:
      good = good && !due;
      break;
    case LinearSolverMethod::kAsynchronous:
      good = TakeFromBackground(has_iterated) && good;
      break;
  }
  tried_ = good;
  return good || Renew();
}

/// Where the last step iterated in vain, the cup moves fast and most likely still does: after the
/// n-th such try in a row 2^n - 1 steps make none.
bool LinearSolver::MayTry() {
  const bool in_vain = iterations_before_ > 0;
  if (in_vain) {
    pause_ = std::min(2 * pause_ + 1, kLongestPause);
    pause_left_ = pause_;
  } else if (tried_) {
    pause_ = 0;
  }
  if (pause_left_ == 0) return true;
  --pause_left_;
  return false;
}

/// Once the second thread has finished, takes the result, if that is newer and wanted.
/// @returns false if it came upon an A that was not positive definite.
bool LinearSolver::TakeFromBackground(bool wanted) {
  if (background_->status() != BackgroundFactorization::Status::kDone) return true;
  BackgroundFactorization::Product* const finished = background_->Finish();
  if (finished == nullptr) return false;
  // A step that could not wait may have made a newer one.
  if (!wanted || background_step_ <= factorized_step_) return true;
  factorization_.SwapFactor(&finished->factorization);
  factorized_step_ = background_step_;
  iterations_since_ = 0;
  prepared_ = &finished->W;
  prepared_of_ = ++generation_;
  return true;
}

bool LinearSolver::MayFactorizeAhead() const {
  return background_ && background_->status() == BackgroundFactorization::Status::kIdle;
}

void LinearSolver::FactorizeAhead(const std::vector<std::vector<NodeColumn>>& columns, double h) {
  if (!MayFactorizeAhead()) return;
  prepared_ = nullptr;
  background_->Start(system_->linearization(), columns, h);
  background_step_ = step_;
}

/// Will more than max_iterations be needed at the pace so far? What earlier solves of the step took
/// does not count: it is spent either way.
/// @param pace Residual now over that at first. @param excess How many times too much is left.
bool LinearSolver::Hopeless(int iterations, double pace, double excess) const {
  constexpr int kTrial = 2;
  const int left = parameters_.max_iterations - iterations;
  if (iterations < kTrial) return left <= 0;
  return excess * std::pow(pace, static_cast<double>(left) / iterations) > 1.0;
}

/// Did the last step take more iterations than the average step since the factorisation, another
/// one and its cost, in iterations, included?
bool LinearSolver::WornOut() const {
  const std::int64_t num_steps = step_ - factorized_step_ + 1;
  return iterations_ * num_steps > parameters_.max_iterations + iterations_since_ + iterations_;
}

bool LinearSolver::Renew() {
  const bool imprecise = usable_ && factorized_step_ == step_;
  if (!imprecise && parameters_.precision == Precision::kSingle &&
      FactorizeWith(Precision::kSingle)) {
    return true;
  }
  return FactorizeWith(Precision::kDouble);
}

bool LinearSolver::FactorizeWith(Precision precision) {
  usable_ = factorization_.Factorize(system_->A_ff(&crew_), precision);
  factorized_step_ = step_;
  iterations_since_ = 0;
  iterations_before_ = iterations_;
  ++generation_;
  ++factorizations_;
  return usable_;
}

void LinearSolver::Start(const ConstraintOperator& constraints, SystemVector* dv, SystemVector* b) {
  Ap_.cup = system_->Multiply(dv->cup, &crew_);
  constraints.BodyImpulses(dv->bodies, &Ap_.bodies);
  const double energy = dv->dot(Ap_);
  const double multiple = energy > 0.0 ? dv->dot(*b) / energy : 0.0;
  *dv *= multiple;
  b->Add(-multiple, Ap_);
}

/// z_ becomes what of r_ the factorisation makes and moves no held row. r_ loses the part that held
/// contacts take, and lambda gains it.
void LinearSolver::Precondition(const ConstraintOperator& constraints, bool any_held,
                                VectorXd* lambda) {
  factorization_.Eliminate(r_.cup, &y_.cup);
  constraints.BodyVelocities(r_.bodies, &y_.bodies);
  if (any_held) {
    constraints.GapChanges(y_, &gap_changes_);
    held_.Forces(gap_changes_, &mu_);
    constraints.AddForces(mu_, &y_);
    constraints.AddImpulses(mu_, &r_);
    *lambda += mu_;
  }
  factorization_.BackSubstitute(y_.cup, &z_.cup);
  z_.bodies = y_.bodies;
}

bool LinearSolver::Refine(const SystemVector& b, const ConstraintOperator& constraints,
                          const std::vector<Index>& held, SystemVector* dv, VectorXd* lambda,
                          double slack) {
  const double bound =
      slack * parameters_.tolerance * std::max(b.cup.norm(), system_->ImpulseScale());
  r_.cup = b.cup - system_->Multiply(dv->cup, &crew_);
  constraints.BodyImpulses(dv->bodies, &r_.bodies);
  r_.bodies = b.bodies - r_.bodies;
  constraints.AddImpulses(*lambda, &r_);
  if (r_.norm() <= bound) return true;

  if (!held_.Compute(constraints.W(), held, {})) return false;
  const double fine = parameters_.position_tolerance / system_->time_step();  // [m/s]
  // The last one, and how far the solution may be from it; of the first one that is not known.
  // [m/s]
  double correction = std::numeric_limits<double>::infinity();
  p_.SetZero(b.cup.size(), b.bodies.size());
  double rz = 1.0;
  double first_size = 0.0;  // of a correction
  const double start = r_.norm();
  for (int i = 0;; ++i) {
    const double residual = r_.norm();
    if (Hopeless(i, residual / start, std::min(residual / bound, correction / fine))) return false;
    ++iterations_;
    Precondition(constraints, !held.empty(), lambda);
    if (r_.norm() <= bound) return true;
    const double rz_before = std::exchange(rz, r_.dot(z_));
    if (!std::isfinite(rz)) return false;
    const double size = z_.LargestEntry();
    if (i == 0) first_size = size;
    // Where A has become softer than what was factorised, corrections are too small, and while they
    // shrink what they leave in the residual does not.
    if (i > 0) correction = size * std::max(1.0, (residual / start) / (size / first_size));
    if (correction <= fine) {
      dv->Add(1.0, z_);
      return true;
    }
    p_ *= rz / rz_before;
    p_.Add(1.0, z_);
    Ap_.cup = system_->Multiply(p_.cup, &crew_);
    constraints.BodyImpulses(p_.bodies, &Ap_.bodies);
    const double pAp = p_.dot(Ap_);
    if (!(pAp > 0.0)) return false;  // A is not positive definite
    dv->Add(rz / pAp, p_);
    r_.Add(-rz / pAp, Ap_);
    if (r_.norm() <= bound) return true;
  }
}

}  // namespace vacuum_gripper_sim
