#include "vacuum_gripper_sim/core/contact_stage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "vacuum_gripper_sim/core/stopwatch.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Passes over measuring, solving and correcting. Planes need one, or one more for each time that
/// the motion brought new nodes to them or, with an earlier factorisation, other contacts turned
/// out to be loaded; spheres and bodies that turn two or three.
constexpr int kMaxPasses = 24;
/// An earlier factorisation that needs more is renewed.
constexpr int kMaxStalePasses = 8;
/// Passes with friction whose forces were not found to the tolerance.
constexpr int kMaxPassesAstray = 3;
/// What folds may pass each other by, or part under load: both sides of the contact turn while it
/// is solved, and nothing depends on where exactly they meet. [m]
constexpr double kFoldSlack = 2e-5;
/// The same of two rigid bodies. [m]
constexpr double kBodySlack = 1e-5;

double Slack(const Contact& contact) {
  if (contact.num_nodes == 0) return kBodySlack;
  return contact.object == RigidWorld::kNone ? kFoldSlack : 0.0;
}

/// Is a loaded contact inside its cone of friction?
bool Sticks(const ContactRows& contact, const VectorXd& lambda) {
  constexpr double kInside = 1.0 - 1e-6;
  return contact.has_tangents() && lambda.segment<2>(contact.tangent()).norm() <
                                       kInside * contact.friction * lambda(contact.normal);
}

std::vector<bool> AreFree(const std::vector<int>& nodes, const ImplicitEuler& system) {
  std::vector<bool> free;
  free.reserve(nodes.size());
  for (const int node : nodes) free.push_back(system.FreeRow(node) >= 0);
  return free;
}

}  // namespace

ContactStage::ContactStage(const TetMesh& mesh, const ImplicitEuler& system, LinearSolver* solver,
                           std::vector<int> surface_nodes, const ContactParameters& parameters)
    : system_(&system),
      solver_(solver),
      surface_nodes_(std::move(surface_nodes)),
      parameters_(parameters),
      finder_(mesh, surface_nodes_, AreFree(surface_nodes_, system)),
      operator_(system),
      expected_columns_(system) {}

void ContactStage::ForgetForces() {
  warm_starts_.clear();
  last_motion_.SetZero(0, 0);
  candidates_of_ = kNoFactorization;
}

void ContactStage::ForgetWorld() {
  ForgetForces();
  expected_.clear();
  finder_.Forget();
}

double ContactStage::Distance(const Vector3d& p_W) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const RigidSurface& surface :
       world_->num_bodies() > 0 ? surfaces_end_ : world_->surfaces()) {
    nearest = std::min(nearest, vacuum_gripper_sim::Distance(surface, p_W).distance);
  }
  return nearest;
}

void ContactStage::Begin(const RigidWorld& world, const Eigen::Matrix3Xd& x,
                         const Eigen::Matrix3Xd& v, const VectorXd& b, const Eigen::Matrix3Xd& dv_c,
                         const VectorXd& b_bodies, double h) {
  world_ = &world;
  x0_ = x;
  v0_ = v;
  b_ = b;
  dv_c_ = dv_c;
  b_bodies_ = b_bodies;
  h_ = h;
  none_.SetZero(b.size(), b_bodies.size());
  finder_.Begin(world, x, h);
  FindCandidates();
  LookAhead();
}

void ContactStage::FindCandidates() {
  const bool some_are_gone =
      std::any_of(candidates_.begin(), candidates_.end(),
                  [&](const Candidate& candidate) { return !finder_.Sees(candidate.contact.key); });
  // Bodies turn, and so do the rows of their contacts.
  if (candidates_of_ != solver_->generation() || world_->num_bodies() > 0 || some_are_gone) {
    StartAfresh();
  }
  FindEnd(none_, &coasting_);
  const auto wanted = [&](std::uint64_t key, double gap) {
    if (IsCandidate(key)) return false;
    if (gap < parameters_.alarm_distance) return true;
    const auto warm_start = warm_starts_.find(key);
    return warm_start != warm_starts_.end() && warm_start->second.normal > 0.0;
  };
  finder_.Select(coasting_, wanted, &selected_);
  AddCandidates(selected_);
}

/// With the contacts that a factorisation from the second thread has brought W of, if all are seen.
void ContactStage::StartAfresh() {
  candidates_of_ = solver_->generation();
  candidates_.clear();
  candidate_keys_.clear();
  std::vector<DelassusOperator>* const prepared = solver_->TakePrepared();
  operator_.Reset(solver_->factorization(), *world_, h_, prepared);
  const auto seen = [&](const Contact& contact) { return finder_.Sees(contact.key); };
  if (prepared != nullptr && std::all_of(expected_.begin(), expected_.end(), seen)) {
    AddCandidates(expected_);
  }
}

/// Hands the step to the second thread, with those of its contacts that touch or come near.
void ContactStage::LookAhead() {
  if (!solver_->MayFactorizeAhead()) return;
  expected_.clear();
  for (const Candidate& candidate : candidates_) {
    // Those of bodies turn from step to step.
    if (world_->num_bodies() > 0) break;
    const Contact contact = finder_.Ahead(candidate.contact.key, coasting_);
    if (candidate.force.x() > 0.0 || contact.gap < parameters_.alarm_distance) {
      expected_.push_back(contact);
    }
  }
  expected_columns_.Reset(solver_->factorization(), *world_);
  expected_columns_.Extend(expected_);
  solver_->FactorizeAhead(expected_columns_.by_piece(), h_);
}

void ContactStage::FindEnd(const SystemVector& dv, TrialEnd* end) {
  system_->Scatter(dv.cup, dv_c_, &end->x_W);
  end->x_W = x0_ + h_ * (v0_ + end->x_W);
  end->dV = dv.bodies;
  end->surfaces = &world_->surfaces();
  if (world_->num_bodies() > 0) {
    world_->SurfacesAfter(dv.bodies, h_, &surfaces_end_);
    end->surfaces = &surfaces_end_;
  }
}

/// Once a candidate, a pair stays one while the factorisation lasts: W grows and never flickers.
void ContactStage::AddCandidates(const std::vector<Contact>& contacts) {
  for (const Contact& contact : contacts) {
    candidate_keys_.push_back(contact.key);
    Candidate candidate;
    candidate.contact = contact;
    const auto warm_start = warm_starts_.find(contact.key);
    if (warm_start != warm_starts_.end()) {
      candidate.force =
          ConstraintOperator::Axes(contact).transpose() * warm_start->second.tangential_W;
      candidate.force.x() = warm_start->second.normal;
    }
    candidates_.push_back(candidate);
  }
  std::sort(candidate_keys_.begin(), candidate_keys_.end());
}

bool ContactStage::IsCandidate(std::uint64_t key) const {
  return std::binary_search(candidate_keys_.begin(), candidate_keys_.end(), key);
}

template <typename Measure>
void ContactStage::MeasureCandidates(const Measure& measure) {
  const auto num_known = static_cast<std::size_t>(operator_.rows().size());
  bool turned = false;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    Candidate& candidate = candidates_[i];
    const Contact measured = measure(candidate.contact.key);
    turned |= i < num_known && operator_.IsPlain(i) && measured.normal != candidate.contact.normal;
    candidate.contact = measured;
  }
  if (turned) operator_.Reset(solver_->factorization(), *world_, h_);
}

void ContactStage::UpdateOperator(StepTimings* timings) {
  const Stopwatch stopwatch(&timings->delassus);
  contacts_.clear();
  for (const Candidate& candidate : candidates_) contacts_.push_back(candidate.contact);
  operator_.SetContacts(contacts_);
}

/// Forces of all candidates, row by row.
const VectorXd& ContactStage::Stack(Vector3d Candidate::*values, VectorXd* stacked) const {
  stacked->resize(operator_.num_rows());
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const ContactRows& rows = operator_.rows()[i];
    const Vector3d& value = candidates_[i].*values;
    (*stacked)(rows.normal) = value.x();
    if (rows.has_tangents()) stacked->segment<2>(rows.tangent()) = value.tail<2>();
  }
  return *stacked;
}

void ContactStage::SetForces(const VectorXd& lambda) {
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const ContactRows& rows = operator_.rows()[i];
    auto& [contact, force, applied] = candidates_[i];
    WarmStart& warm_start = warm_starts_[contact.key];
    force.x() = lambda(rows.normal);
    warm_start.normal = force.x();
    if (!rows.has_tangents()) continue;
    force.tail<2>() = lambda.segment<2>(rows.tangent());
    warm_start.tangential_W = ConstraintOperator::Axes(contact).rightCols<2>() * force.tail<2>();
  }
}

/// Adds to y_, on entry that of the impulse, that of the forces' changes.
void ContactStage::SolveCandidates(ContactSolution* solution, StepTimings* timings) {
  const Stopwatch stopwatch(&timings->solve);
  operator_.GapChanges(y_, &delta_);
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Contact& contact = candidates_[i].contact;
    const ContactRows& rows = operator_.rows()[i];
    delta_(rows.normal) += contact.gap;
    if (!rows.has_tangents()) continue;
    delta_.segment<2>(rows.tangent()) +=
        ConstraintOperator::Axes(contact).rightCols<2>().transpose() * contact.slip_W;
  }
  Stack(&Candidate::force, &lambda_);
  Stack(&Candidate::applied, &applied_);
  if (!applied_.isZero(0.0)) operator_.W().AddTimes(-1.0, applied_, &delta_);
  const McpStatistics statistics =
      contact_solver_.Solve(operator_.W(), delta_, operator_.rows(), parameters_, &lambda_);
  solution->statistics.iterations += statistics.iterations;
  solution->statistics.residual = statistics.residual;
  solution->statistics.converged = statistics.converged;
  SetForces(lambda_);
  lambda_ -= applied_;
  operator_.AddForces(lambda_, &y_);
}

/// Makes motion and forces of the loaded contacts those of the true A.
/// @returns false if that took too many iterations.
bool ContactStage::Refine(ContactSolution* solution) {
  Stack(&Candidate::force, &lambda_);
  held_.clear();
  for (const ContactRows& contact : operator_.rows()) {
    if (lambda_(contact.normal) <= 0.0) continue;
    held_.push_back(contact.normal);
    if (!Sticks(contact, lambda_)) continue;
    held_.push_back(contact.tangent());
    held_.push_back(contact.tangent() + 1);
  }
  const double slack = accuracy_ == Accuracy::kTrial ? kTrialSlack : 1.0;
  const bool converged =
      solver_->Refine(impulse_, operator_, held_, &solution->dv, &lambda_, slack);
  SetForces(lambda_);
  return converged;
}

bool ContactStage::Solve(const Eigen::Matrix3Xd& load, Accuracy accuracy, ContactSolution* solution,
                         StepTimings* timings) {
  accuracy_ = accuracy;
  PressureOnObjects(load, x0_, finder_, *world_, &pressure_on_);
  system_->GatherFree(load, &impulse_.cup);
  impulse_.cup = b_ + h_ * impulse_.cup;
  impulse_.bodies = b_bodies_;
  for (std::size_t object = 0; object < pressure_on_.size(); ++object) {
    const int body = world_->BodyOf(static_cast<int>(object));
    if (body == RigidWorld::kNone) continue;
    const ObjectLoad& on_object = pressure_on_[object];
    const Vector3d arm = world_->objects()[object].X_WO.translation() - world_->CentreOfMass(body);
    impulse_.bodies.segment<3>(6 * body) += h_ * on_object.force_W;
    impulse_.bodies.segment<3>(6 * body + 3) +=
        h_ * (on_object.torque_W + arm.cross(on_object.force_W));
  }
  while (!SolveWithFactorization(solution, timings)) {
    const Stopwatch stopwatch(&timings->factorization);
    if (!solver_->Renew()) return false;
    FindCandidates();
  }
  Report(solution);
  return true;
}

/// Half solves for the free motion. A factorisation that is not the step's own errs by what it is
/// asked to bridge: by less from the last forces and the last motion on.
void ContactStage::Start(ContactSolution* solution, StepTimings* timings) {
  solution->statistics = McpStatistics();
  solution->dv = none_;
  MeasureCandidates([&](std::uint64_t key) { return finder_.Ahead(key, coasting_); });
  for (Candidate& candidate : candidates_) {
    candidate.applied = solver_->current() ? Vector3d::Zero().eval() : candidate.force;
  }
  UpdateOperator(timings);
  const Stopwatch stopwatch(&timings->free_motion);
  with_forces_ = impulse_;
  operator_.AddImpulses(Stack(&Candidate::applied, &applied_), &with_forces_);
  const bool knows_a_motion = last_motion_.cup.size() == none_.cup.size() &&
                              last_motion_.bodies.size() == none_.bodies.size();
  if (solver_->old() && knows_a_motion) {
    solution->dv = last_motion_;
    solver_->Start(operator_, &solution->dv, &with_forces_);
    FindEnd(solution->dv, &end_);
    MeasureCandidates([&](std::uint64_t key) { return finder_.Ahead(key, end_); });
  }
  solver_->factorization().Eliminate(with_forces_.cup, &y_.cup);
  operator_.BodyVelocities(with_forces_.bodies, &y_.bodies);
}

/// @returns false if the factorisation is too old for this.
bool ContactStage::SolveWithFactorization(ContactSolution* solution, StepTimings* timings) {
  Start(solution, timings);
  solution->settled = false;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    if (pass > 0) {
      UpdateOperator(timings);
      y_ = none_;
    }
    SolveCandidates(solution, timings);
    {
      const Stopwatch stopwatch(&timings->correction);
      solver_->factorization().BackSubstitute(y_.cup, &dv_of_pass_);
      solution->dv.cup += dv_of_pass_;
      solution->dv.bodies += y_.bodies;
      if (!solver_->current() && (pass == kMaxStalePasses || !Refine(solution))) {
        return false;
      }
      FindEnd(solution->dv, &end_);
    }

    const Stopwatch stopwatch(&timings->narrow_phase);
    MeasureEnd(end_, solution);
    solution->x_W = end_.x_W;
    const double bound =
        std::min(parameters_.acceptable_residual,
                 std::max(10.0 * parameters_.tolerance, 2.0 * solution->statistics.residual));
    const auto missed = [&](std::uint64_t key, double gap) {
      return gap < parameters_.alarm_distance && !IsCandidate(key);
    };
    finder_.Select(end_, missed, &selected_);
    const bool passed = std::any_of(selected_.begin(), selected_.end(),
                                    [&](const Contact& contact) { return contact.gap < -bound; });
    solution->settled = !passed && solution->error <= bound;
    if (solution->settled) break;
    // Forces with friction that are not found from here are hardly found from a little further.
    if (!solution->statistics.converged && !operator_.plain() && pass >= kMaxPassesAstray) break;

    MeasureCandidates([&](std::uint64_t key) { return finder_.At(key, end_); });
    for (Candidate& candidate : candidates_) candidate.applied = candidate.force;
    if (passed) AddCandidates(selected_);
  }
  last_motion_ = solution->dv;
  return true;
}

void ContactStage::MeasureEnd(const TrialEnd& end, ContactSolution* solution) {
  finder_.MoveTo(end);
  finder_.Nearest(end, &nearest_);
  solution->distance.assign(static_cast<std::size_t>(x0_.cols()),
                            std::numeric_limits<double>::infinity());
  double deepest = 0.0;
  for (std::size_t i = 0; i < surface_nodes_.size(); ++i) {
    const int node = surface_nodes_[i];
    solution->distance[static_cast<std::size_t>(node)] = nearest_[i];
    if (system_->FreeRow(node) >= 0) deepest = std::min(deepest, nearest_[i]);
  }
  solution->max_penetration = -deepest;
  solution->error = -deepest;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i];
    const bool is_node = candidate.contact.num_nodes == 1;  // measured above
    const bool is_loaded = candidate.force.x() > 0.0;
    if (is_loaded || !is_node) {
      const double gap = finder_.At(candidate.contact.key, end).gap;
      solution->error =
          std::max(solution->error, (is_loaded ? std::abs(gap) : -gap) - Slack(candidate.contact));
    }
    // Refined forces may pull, and leave their cones.
    const ContactRows& rows = operator_.rows()[i];
    if (!is_loaded) {
      const double compliance = operator_.W().Diagonal(rows.normal);
      solution->error = std::max(solution->error, -candidate.force.x() * compliance);
    } else if (rows.has_tangents()) {
      const double excess = candidate.force.tail<2>().norm() - rows.friction * candidate.force.x();
      const double compliance = operator_.W().Diagonal(rows.tangent());
      solution->error = std::max(solution->error, excess * compliance);
    }
  }
}

void ContactStage::Report(ContactSolution* solution) const {
  solution->contact_nodes.clear();
  solution->contact_force = 0.0;
  solution->fold_force = 0.0;
  solution->num_candidates = static_cast<int>(candidates_.size());
  solution->lambda.setZero(x0_.cols());
  solution->on_objects.setZero(x0_.cols());
  solution->forces_W.setZero(3, x0_.cols());
  solution->objects = pressure_on_;
  Vector3d friction_W = Vector3d::Zero();
  for (const Candidate& candidate : candidates_) {
    const Contact& contact = candidate.contact;
    const double normal_force = std::max(0.0, candidate.force.x());
    if (contact.num_nodes == 0 || normal_force == 0.0) continue;
    solution->contact_nodes.push_back(contact.nodes[0]);
    for (int k = 0; k < contact.num_nodes; ++k) {
      const auto place = static_cast<std::size_t>(k);
      const double share = std::abs(contact.weights[place]) * normal_force;
      solution->lambda(contact.nodes[place]) += share;
      if (contact.object != RigidWorld::kNone) solution->on_objects(contact.nodes[place]) += share;
    }
    Vector3d on_cup_W = normal_force * contact.normal;
    if (contact.friction > 0.0) {
      const Vector3d tangential_W =
          ConstraintOperator::Axes(contact).rightCols<2>() * candidate.force.tail<2>();
      on_cup_W += tangential_W;
      friction_W += tangential_W;
    }
    for (int k = 0; k < contact.num_nodes; ++k) {
      const auto place = static_cast<std::size_t>(k);
      solution->forces_W.col(contact.nodes[place]) += contact.weights[place] * on_cup_W;
    }
    if (contact.object == RigidWorld::kNone) {
      solution->fold_force += normal_force;
      continue;  // within the cup
    }
    solution->contact_force += normal_force;
    const auto object = static_cast<std::size_t>(contact.object);
    const Vector3d arm = contact.p_W - world_->objects()[object].X_WO.translation();
    solution->objects[object].force_W -= on_cup_W;
    solution->objects[object].torque_W -= arm.cross(on_cup_W);
  }
  solution->friction_force = friction_W.norm();
}

}  // namespace vacuum_gripper_sim
