#include "vacuum_gripper_sim/core/contact_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vacuum_gripper_sim/core/stopwatch.h"

namespace vacuum_gripper_sim {
namespace {

/// Passes over measuring, solving and correcting; planes need one, spheres two or three.
constexpr int kMaxPasses = 8;

bool SamePair(const Contact& a, const Contact& b) {
  return a.node == b.node && a.surface == b.surface;
}

bool Before(const Contact& a, const Contact& b) {
  return a.node != b.node ? a.node < b.node : a.surface < b.surface;
}

}  // namespace

ContactStage::ContactStage(const ImplicitEuler& system, LinearSolver* solver,
                           std::vector<int> surface_nodes, const ContactParameters& parameters)
    : system_(&system),
      solver_(solver),
      surface_nodes_(std::move(surface_nodes)),
      parameters_(parameters) {}

void ContactStage::ForgetForces() { forces_.clear(); }

void ContactStage::Begin(const std::vector<RigidSurface>& surfaces, const Eigen::Matrix3Xd& x,
                         const Eigen::Matrix3Xd& v, const Eigen::VectorXd& dv_f,
                         const Eigen::Matrix3Xd& dv_c, double h) {
  surfaces_ = &surfaces;
  x0_ = x;
  v0_ = v;
  dv_free_ = dv_f;
  dv_c_ = dv_c;
  h_ = h;
  candidates_.clear();
  H_transposed_.resize(dv_f.size(), 0);
  W_.resize(0, 0);
  forces_.resize(static_cast<std::size_t>(x.cols()) * surfaces.size(), 0.0);
}

double& ContactStage::ForceOf(const Contact& contact) {
  return forces_[static_cast<std::size_t>(contact.node) * surfaces_->size() +
                 static_cast<std::size_t>(contact.surface)];
}

Eigen::Matrix3Xd ContactStage::EndPositions(const Eigen::VectorXd& dv_f) const {
  return x0_ + h_ * (v0_ + system_->Scatter(dv_f, dv_c_));
}

void ContactStage::UpdateCandidates(const Eigen::Matrix3Xd& measured_at, const Eigen::Matrix3Xd& x,
                                    StepTimings* timings) {
  std::vector<Contact> updated;
  {
    const Stopwatch stopwatch(&timings->narrow_phase);
    updated = DetectAhead(*surfaces_, surface_nodes_, measured_at, x, parameters_.alarm_distance);
    // Once a candidate, a pair stays one to the end of the step: W then grows and never flickers.
    std::vector<Contact> kept;
    for (const Contact& old : candidates_) {
      if (std::binary_search(updated.begin(), updated.end(), old, Before)) continue;
      const SurfaceDistance seen =
          Distance((*surfaces_)[static_cast<std::size_t>(old.surface)], measured_at.col(old.node));
      const double gap =
          seen.distance + seen.normal.dot(x.col(old.node) - measured_at.col(old.node));
      kept.push_back({old.node, old.surface, gap, seen.normal});
    }
    const auto middle = static_cast<std::ptrdiff_t>(updated.size());
    updated.insert(updated.end(), kept.begin(), kept.end());
    std::inplace_merge(updated.begin(), updated.begin() + middle, updated.end(), Before);
  }
  const bool same = updated.size() == candidates_.size() &&
                    std::equal(updated.begin(), updated.end(), candidates_.begin(),
                               [](const Contact& a, const Contact& b) {
                                 return SamePair(a, b) && a.normal == b.normal;
                               });
  candidates_ = std::move(updated);
  if (!same) RebuildDelassus(timings);
}

void ContactStage::RebuildDelassus(StepTimings* timings) {
  const Stopwatch stopwatch(&timings->delassus);
  const auto num_contacts = static_cast<Eigen::Index>(candidates_.size());
  H_transposed_.resize(3 * system_->num_free(), num_contacts);
  H_transposed_.reserve(Eigen::VectorXi::Constant(num_contacts, 3));
  for (int c = 0; c < num_contacts; ++c) {
    const Contact& contact = candidates_[static_cast<std::size_t>(c)];
    const int row = system_->FreeRow(contact.node);
    for (int i = 0; i < 3; ++i) H_transposed_.insert(row + i, c) = contact.normal(i);
  }
  H_transposed_.makeCompressed();
  // The Delassus operator W = h^2 H A^-1 H^T; the paper leaves the h^2, which makes it a
  // displacement a force, implicit.
  W_ = h_ * h_ * solver_->factorization().InverseForm(H_transposed_);
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
  solution->dv_f = dv_loaded;
  solution->x_W = EndPositions(dv_loaded);
  Eigen::VectorXd lambda;  // of candidates_
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const std::vector<Contact> old_candidates = candidates_;
    const Eigen::VectorXd old_lambda = lambda;
    UpdateCandidates(pass == 0 ? x0_ : solution->x_W, solution->x_W, timings);
    const auto num_contacts = static_cast<Eigen::Index>(candidates_.size());

    // delta = gap(x_end) - W lambda, lambda being the force that led to x_end.
    Eigen::VectorXd applied = Eigen::VectorXd::Zero(num_contacts);
    if (pass > 0) {
      for (std::size_t i = 0; i < old_candidates.size(); ++i) {
        const auto place =
            std::lower_bound(candidates_.begin(), candidates_.end(), old_candidates[i], Before);
        applied(place - candidates_.begin()) = old_lambda(static_cast<Eigen::Index>(i));
      }
    }
    Eigen::VectorXd delta(num_contacts);
    lambda.resize(num_contacts);
    for (Eigen::Index i = 0; i < num_contacts; ++i) {
      const Contact& contact = candidates_[static_cast<std::size_t>(i)];
      delta(i) = contact.gap;
      lambda(i) = ForceOf(contact);
    }
    {
      const Stopwatch stopwatch(&timings->solve);
      if (pass > 0) delta.noalias() -= W_ * applied;
      const McpStatistics statistics = SolveContacts(W_, delta, parameters_, &lambda);
      solution->statistics.iterations += statistics.iterations;
      solution->statistics.residual = statistics.residual;
      solution->statistics.converged = statistics.converged;
    }
    for (Eigen::Index i = 0; i < num_contacts; ++i) {
      ForceOf(candidates_[static_cast<std::size_t>(i)]) = lambda(i);
    }

    {
      const Stopwatch stopwatch(&timings->correction);
      solution->dv_f = dv_loaded;
      if (num_contacts > 0) {
        Eigen::VectorXd correction;
        if (!solver_->Solve(h_ * (H_transposed_ * lambda), &correction)) return false;
        solution->dv_f += correction;
      }
      solution->x_W = EndPositions(solution->dv_f);
    }
    const Stopwatch stopwatch(&timings->narrow_phase);
    MeasureEnd(solution);
    for (Eigen::Index i = 0; i < num_contacts; ++i) {
      if (lambda(i) <= 0.0) continue;
      const Contact& contact = candidates_[static_cast<std::size_t>(i)];
      const double gap = Distance((*surfaces_)[static_cast<std::size_t>(contact.surface)],
                                  solution->x_W.col(contact.node))
                             .distance;
      solution->error = std::max(solution->error, std::abs(gap));
    }
    const double bound =
        std::max(10.0 * parameters_.tolerance, 2.0 * solution->statistics.residual);
    if (solution->error <= bound) break;
  }

  solution->num_candidates = static_cast<int>(candidates_.size());
  solution->contact_force.setZero(3, x0_.cols());
  solution->lambda.setZero(x0_.cols());
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const double force = lambda(static_cast<Eigen::Index>(i));
    solution->contact_force.col(candidates_[i].node) += force * candidates_[i].normal;
    solution->lambda(candidates_[i].node) += force;
  }
  return true;
}

void ContactStage::MeasureEnd(ContactSolution* solution) const {
  solution->distance = DetectProximity(*surfaces_, surface_nodes_, solution->x_W, 0.0).distance;
  double deepest = 0.0;
  for (const double distance : solution->distance) deepest = std::min(deepest, distance);
  solution->max_penetration = -deepest;
  solution->error = -deepest;
}

}  // namespace vacuum_gripper_sim
