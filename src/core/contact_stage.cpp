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
/// the motion brought new nodes to them; spheres two or three.
constexpr int kMaxPasses = 12;

bool Before(const Contact& a, const Contact& b) {
  return a.node != b.node ? a.node < b.node : a.surface < b.surface;
}

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

void ContactStage::ForgetForces() { warm_starts_.clear(); }

void ContactStage::Begin(const std::vector<RigidSurface>& surfaces, const Eigen::Matrix3Xd& x,
                         const Eigen::Matrix3Xd& v, const Eigen::VectorXd& dv_f,
                         const Eigen::Matrix3Xd& dv_c, double h) {
  surfaces_ = &surfaces;
  x0_ = x;
  v0_ = v;
  dv_free_ = dv_f;
  dv_c_ = dv_c;
  h_ = h;
  warm_starts_.resize(static_cast<std::size_t>(x.cols()) * surfaces.size(), 0.0);
  narrow_phase_.Begin(surfaces, contact_nodes_, x);
  candidates_.clear();
  delassus_outdated_ = true;
  AddCandidates(narrow_phase_.Near(x, parameters_.alarm_distance));
}

double& ContactStage::WarmStart(const Contact& contact) {
  return warm_starts_[static_cast<std::size_t>(contact.node) * surfaces_->size() +
                      static_cast<std::size_t>(contact.surface)];
}

bool ContactStage::IsCandidate(const Contact& contact) const {
  const auto place =
      std::lower_bound(candidates_.begin(), candidates_.end(), contact,
                       [](const Candidate& a, const Contact& b) { return Before(a.contact, b); });
  return place != candidates_.end() && !Before(contact, place->contact);
}

/// Once a candidate, a pair stays one to the end of the step: W grows and never flickers.
void ContactStage::AddCandidates(const std::vector<Contact>& contacts) {
  const auto old_size = static_cast<std::ptrdiff_t>(candidates_.size());
  for (const Contact& contact : contacts) {
    candidates_.push_back({contact, WarmStart(contact), 0.0});
  }
  std::inplace_merge(
      candidates_.begin(), candidates_.begin() + old_size, candidates_.end(),
      [](const Candidate& a, const Candidate& b) { return Before(a.contact, b.contact); });
  delassus_outdated_ |= !contacts.empty();
}

template <typename Measure>
void ContactStage::MeasureCandidates(const Measure& measure) {
  for (Candidate& candidate : candidates_) {
    const Contact measured = measure(candidate.contact.node, candidate.contact.surface);
    delassus_outdated_ |= measured.normal != candidate.contact.normal;
    candidate.contact = measured;
  }
}

void ContactStage::UpdateDelassus(StepTimings* timings) {
  if (!delassus_outdated_) return;
  const Stopwatch stopwatch(&timings->delassus);
  const auto num_candidates = static_cast<Eigen::Index>(candidates_.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int c = 0; c < num_candidates; ++c) {
    const Contact& contact = candidates_[static_cast<std::size_t>(c)].contact;
    const int row = system_->FreeRow(contact.node);
    for (int i = 0; i < 3; ++i) entries.emplace_back(row + i, c, contact.normal(i));
  }
  H_transposed_.resize(3 * system_->num_free(), num_candidates);
  H_transposed_.setFromTriplets(entries.begin(), entries.end());
  // The Delassus operator W = h^2 H A^-1 H^T; the paper leaves the h^2, which makes it a
  // displacement a force, implicit.
  W_ = h_ * h_ * solver_->factorization().InverseForm(H_transposed_);
  delassus_outdated_ = false;
}

void ContactStage::SolveCandidates(ContactSolution* solution, StepTimings* timings) {
  const Stopwatch stopwatch(&timings->solve);
  const auto num_candidates = static_cast<Eigen::Index>(candidates_.size());
  Eigen::VectorXd delta(num_candidates);
  Eigen::VectorXd lambda(num_candidates);
  Eigen::VectorXd applied(num_candidates);
  for (Eigen::Index i = 0; i < num_candidates; ++i) {
    const Candidate& candidate = candidates_[static_cast<std::size_t>(i)];
    delta(i) = candidate.contact.gap;
    lambda(i) = candidate.force;
    applied(i) = candidate.applied;
  }
  if (!applied.isZero(0.0)) delta.noalias() -= W_ * applied;
  const McpStatistics statistics = SolveContacts(W_, delta, parameters_, &lambda);
  solution->statistics.iterations += statistics.iterations;
  solution->statistics.residual = statistics.residual;
  solution->statistics.converged = statistics.converged;
  for (Eigen::Index i = 0; i < num_candidates; ++i) {
    Candidate& candidate = candidates_[static_cast<std::size_t>(i)];
    candidate.force = lambda(i);
    WarmStart(candidate.contact) = lambda(i);
  }
}

bool ContactStage::Correct(const Eigen::VectorXd& dv_loaded, ContactSolution* solution,
                           StepTimings* timings) {
  const Stopwatch stopwatch(&timings->correction);
  solution->dv_f = dv_loaded;
  if (!candidates_.empty()) {
    Eigen::VectorXd lambda(static_cast<Eigen::Index>(candidates_.size()));
    for (Eigen::Index i = 0; i < lambda.size(); ++i) {
      lambda(i) = candidates_[static_cast<std::size_t>(i)].force;
    }
    Eigen::VectorXd correction;
    if (!solver_->Solve(h_ * (H_transposed_ * lambda), &correction)) return false;
    solution->dv_f += correction;
  }
  solution->x_W = EndPositions(solution->dv_f);
  return true;
}

bool ContactStage::Solve(const Eigen::Matrix3Xd& load, ContactSolution* solution,
                         StepTimings* timings) {
  Eigen::VectorXd dv_loaded = dv_free_;
  if (!load.isZero(0.0)) {
    const Stopwatch stopwatch(&timings->correction);
    Eigen::VectorXd dv_load;
    if (!solver_->Solve(h_ * system_->GatherFree(load), &dv_load)) return false;
    dv_loaded += dv_load;
  }

  *solution = ContactSolution();
  const Eigen::Matrix3Xd x_loaded = EndPositions(dv_loaded);
  MeasureCandidates(
      [&](int node, int surface) { return narrow_phase_.Ahead(node, surface, x_loaded); });
  for (Candidate& candidate : candidates_) candidate.applied = 0.0;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    UpdateDelassus(timings);
    SolveCandidates(solution, timings);
    if (!Correct(dv_loaded, solution, timings)) return false;

    const Stopwatch stopwatch(&timings->narrow_phase);
    MeasureEnd(solution);
    const double bound =
        std::min(parameters_.acceptable_residual,
                 std::max(10.0 * parameters_.tolerance, 2.0 * solution->statistics.residual));
    std::vector<Contact> missed = narrow_phase_.Reaching(solution->x_W, parameters_.alarm_distance);
    missed.erase(std::remove_if(missed.begin(), missed.end(),
                                [&](const Contact& contact) { return IsCandidate(contact); }),
                 missed.end());
    const bool passed = std::any_of(missed.begin(), missed.end(),
                                    [&](const Contact& contact) { return contact.gap < -bound; });
    if (!passed && solution->error <= bound) break;

    MeasureCandidates(
        [&](int node, int surface) { return narrow_phase_.At(node, surface, solution->x_W); });
    for (Candidate& candidate : candidates_) candidate.applied = candidate.force;
    if (passed) AddCandidates(missed);
  }
  Report(solution);
  return true;
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
  for (const Candidate& candidate : candidates_) {
    if (candidate.force <= 0.0) continue;
    const Contact end =
        narrow_phase_.At(candidate.contact.node, candidate.contact.surface, solution->x_W);
    solution->error = std::max(solution->error, std::abs(end.gap));
  }
}

void ContactStage::Report(ContactSolution* solution) const {
  solution->num_candidates = static_cast<int>(candidates_.size());
  solution->lambda.setZero(x0_.cols());
  for (const Candidate& candidate : candidates_) {
    solution->lambda(candidate.contact.node) += candidate.force;
  }
}

}  // namespace vacuum_gripper_sim
