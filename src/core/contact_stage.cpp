#include "vacuum_gripper_sim/core/contact_stage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

#include "vacuum_gripper_sim/core/stopwatch.h"

namespace vacuum_gripper_sim {
namespace {

/// Passes over measuring, solving and correcting. Planes need one, or one more for each time that
/// the motion brought new nodes to them or, with an earlier factorisation, other contacts turned
/// out to be loaded; spheres two or three.
constexpr int kMaxPasses = 24;
/// An earlier factorisation that needs more is renewed.
constexpr int kMaxStalePasses = 8;

}  // namespace

ContactStage::ContactStage(const ImplicitEuler& system, LinearSolver* solver,
                           std::vector<int> surface_nodes, const ContactParameters& parameters)
    : system_(&system),
      solver_(solver),
      surface_nodes_(std::move(surface_nodes)),
      parameters_(parameters) {
  std::copy_if(surface_nodes_.begin(), surface_nodes_.end(), std::back_inserter(contact_nodes_),
               [&](int node) { return system_->FreeRow(node) >= 0; });
}

void ContactStage::ForgetForces() {
  warm_starts_.clear();
  candidates_of_ = kNoFactorization;
}

void ContactStage::Begin(const std::vector<RigidSurface>& surfaces, const Eigen::Matrix3Xd& x,
                         const Eigen::Matrix3Xd& v, const Eigen::VectorXd& b,
                         const Eigen::Matrix3Xd& dv_c, double h) {
  surfaces_ = &surfaces;
  x0_ = x;
  v0_ = v;
  b_ = b;
  dv_c_ = dv_c;
  h_ = h;
  warm_starts_.resize(static_cast<std::size_t>(x.cols()) * surfaces.size(), 0.0);
  narrow_phase_.Begin(surfaces, contact_nodes_, x);
  FindCandidates();
}

void ContactStage::FindCandidates() {
  if (candidates_of_ != solver_->generation()) {
    candidates_of_ = solver_->generation();
    candidates_.clear();
    is_candidate_.assign(warm_starts_.size(), false);
    delassus_.Reset(solver_->factorization(), h_);
  }
  const Eigen::VectorXd no_change = Eigen::VectorXd::Zero(b_.size());
  AddCandidates(narrow_phase_.Select(EndPositions(no_change), [&](const Contact& contact) {
    const std::size_t pair = PairIndex(contact);
    return !is_candidate_[pair] &&
           (contact.gap < parameters_.alarm_distance || warm_starts_[pair] > 0.0);
  }));
}

std::size_t ContactStage::PairIndex(const Contact& contact) const {
  return static_cast<std::size_t>(contact.node) * surfaces_->size() +
         static_cast<std::size_t>(contact.surface);
}

/// Once a candidate, a pair stays one while the factorisation lasts: W grows and never flickers.
void ContactStage::AddCandidates(const std::vector<Contact>& contacts) {
  for (const Contact& contact : contacts) {
    const std::size_t pair = PairIndex(contact);
    is_candidate_[pair] = true;
    candidates_.push_back({contact, warm_starts_[pair], 0.0});
  }
}

template <typename Measure>
void ContactStage::MeasureCandidates(const Measure& measure) {
  bool turned = false;
  for (Candidate& candidate : candidates_) {
    const Contact measured = measure(candidate.contact.node, candidate.contact.surface);
    turned |= measured.normal != candidate.contact.normal;
    candidate.contact = measured;
  }
  if (turned) delassus_.Reset(solver_->factorization(), h_);
}

void ContactStage::UpdateDelassus(StepTimings* timings) {
  const Stopwatch stopwatch(&timings->delassus);
  std::vector<NodeColumn> H_rows;
  for (auto i = static_cast<std::size_t>(delassus_.num_contacts()); i < candidates_.size(); ++i) {
    const Contact& contact = candidates_[i].contact;
    H_rows.push_back({system_->FreeRow(contact.node) / 3, contact.normal});
  }
  delassus_.Append(H_rows);
}

/// @param[in,out] y On entry the impulse, on exit with that of the forces' changes.
void ContactStage::SolveCandidates(Eigen::VectorXd* y, ContactSolution* solution,
                                   StepTimings* timings) {
  const Stopwatch stopwatch(&timings->solve);
  const auto num_candidates = static_cast<Eigen::Index>(candidates_.size());
  Eigen::VectorXd delta = delassus_.GapChanges(*y);
  Eigen::VectorXd lambda(num_candidates);
  Eigen::VectorXd applied(num_candidates);
  for (Eigen::Index i = 0; i < num_candidates; ++i) {
    const Candidate& candidate = candidates_[static_cast<std::size_t>(i)];
    delta(i) += candidate.contact.gap;
    lambda(i) = candidate.force;
    applied(i) = candidate.applied;
  }
  if (!applied.isZero(0.0)) delta.noalias() -= delassus_.W() * applied;
  const McpStatistics statistics = SolveContacts(delassus_.W(), delta, parameters_, &lambda);
  solution->statistics.iterations += statistics.iterations;
  solution->statistics.residual = statistics.residual;
  solution->statistics.converged = statistics.converged;
  for (Eigen::Index i = 0; i < num_candidates; ++i) {
    Candidate& candidate = candidates_[static_cast<std::size_t>(i)];
    candidate.force = lambda(i);
    warm_starts_[PairIndex(candidate.contact)] = lambda(i);
  }
  delassus_.AddForces(lambda - applied, y);
}

/// Makes motion and forces of the loaded contacts those of the true A.
/// @returns false if that took too many iterations.
bool ContactStage::Refine(const Eigen::VectorXd& impulse, ContactSolution* solution) {
  Eigen::VectorXd lambda(static_cast<Eigen::Index>(candidates_.size()));
  std::vector<Eigen::Index> held;
  for (Eigen::Index i = 0; i < lambda.size(); ++i) {
    lambda(i) = candidates_[static_cast<std::size_t>(i)].force;
    if (lambda(i) > 0.0) held.push_back(i);
  }
  const bool converged = solver_->Refine(impulse, delassus_, held, &solution->dv_f, &lambda);
  for (Eigen::Index i = 0; i < lambda.size(); ++i) {
    Candidate& candidate = candidates_[static_cast<std::size_t>(i)];
    candidate.force = lambda(i);
    warm_starts_[PairIndex(candidate.contact)] = lambda(i);
  }
  return converged;
}

bool ContactStage::Solve(const Eigen::Matrix3Xd& load, ContactSolution* solution,
                         StepTimings* timings) {
  const Eigen::VectorXd impulse = b_ + h_ * system_->GatherFree(load);
  while (!SolveWithFactorization(impulse, solution, timings)) {
    const Stopwatch stopwatch(&timings->factorization);
    if (!solver_->Renew()) return false;
    FindCandidates();
  }
  Report(solution);
  return true;
}

/// @returns false if the factorisation is too old for this.
bool ContactStage::SolveWithFactorization(const Eigen::VectorXd& impulse, ContactSolution* solution,
                                          StepTimings* timings) {
  *solution = ContactSolution();
  solution->dv_f.setZero(impulse.size());
  const Eigen::Matrix3Xd x_coasting = EndPositions(solution->dv_f);
  MeasureCandidates(
      [&](int node, int surface) { return narrow_phase_.Ahead(node, surface, x_coasting); });
  // An earlier factorisation errs by what it is asked to bridge: by less from the last forces on.
  for (Candidate& candidate : candidates_) {
    candidate.applied = solver_->current() ? 0.0 : candidate.force;
  }
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    UpdateDelassus(timings);
    Eigen::VectorXd y = Eigen::VectorXd::Zero(impulse.size());
    if (pass == 0) {
      const Stopwatch stopwatch(&timings->free_motion);
      y = solver_->factorization().Eliminate(WithAppliedForces(impulse));
    }
    SolveCandidates(&y, solution, timings);
    {
      const Stopwatch stopwatch(&timings->correction);
      solution->dv_f += solver_->factorization().BackSubstitute(std::move(y));
      if (!solver_->current() && (pass == kMaxStalePasses || !Refine(impulse, solution))) {
        return false;
      }
      solution->x_W = EndPositions(solution->dv_f);
    }

    const Stopwatch stopwatch(&timings->narrow_phase);
    MeasureEnd(solution);
    const double bound =
        std::min(parameters_.acceptable_residual,
                 std::max(10.0 * parameters_.tolerance, 2.0 * solution->statistics.residual));
    const std::vector<Contact> missed =
        narrow_phase_.Select(solution->x_W, [&](const Contact& contact) {
          return contact.gap < parameters_.alarm_distance && !is_candidate_[PairIndex(contact)];
        });
    const bool passed = std::any_of(missed.begin(), missed.end(),
                                    [&](const Contact& contact) { return contact.gap < -bound; });
    if (!passed && solution->error <= bound) break;

    MeasureCandidates(
        [&](int node, int surface) { return narrow_phase_.At(node, surface, solution->x_W); });
    for (Candidate& candidate : candidates_) candidate.applied = candidate.force;
    if (passed) AddCandidates(missed);
  }
  return true;
}

Eigen::VectorXd ContactStage::WithAppliedForces(Eigen::VectorXd impulse) const {
  for (const Candidate& candidate : candidates_) {
    impulse.segment<3>(system_->FreeRow(candidate.contact.node)) +=
        h_ * candidate.applied * candidate.contact.normal;
  }
  return impulse;
}

Eigen::Matrix3Xd ContactStage::EndPositions(const Eigen::VectorXd& dv_f) const {
  return x0_ + h_ * (v0_ + system_->Scatter(dv_f, dv_c_));
}

void ContactStage::MeasureEnd(ContactSolution* solution) const {
  const std::vector<double> nearest = NearestDistances(*surfaces_, surface_nodes_, solution->x_W);
  solution->distance.assign(static_cast<std::size_t>(x0_.cols()),
                            std::numeric_limits<double>::infinity());
  double deepest = 0.0;
  for (std::size_t i = 0; i < surface_nodes_.size(); ++i) {
    const int node = surface_nodes_[i];
    solution->distance[static_cast<std::size_t>(node)] = nearest[i];
    if (system_->FreeRow(node) >= 0) deepest = std::min(deepest, nearest[i]);
  }
  solution->max_penetration = -deepest;
  solution->error = -deepest;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const auto& [contact, force, applied] = candidates_[i];
    double error = 0.0;
    if (force > 0.0) {
      error = std::abs(narrow_phase_.At(contact.node, contact.surface, solution->x_W).gap);
    } else {  // refined forces may pull
      const auto diagonal = static_cast<Eigen::Index>(i);
      error = -force * delassus_.W()(diagonal, diagonal);
    }
    solution->error = std::max(solution->error, error);
  }
}

void ContactStage::Report(ContactSolution* solution) const {
  solution->num_candidates = static_cast<int>(candidates_.size());
  solution->lambda.setZero(x0_.cols());
  for (const Candidate& candidate : candidates_) {
    solution->lambda(candidate.contact.node) += std::max(0.0, candidate.force);
  }
}

}  // namespace vacuum_gripper_sim
