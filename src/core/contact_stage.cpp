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

std::vector<bool> AreFree(const std::vector<int>& nodes, const ImplicitEuler& system) {
  std::vector<bool> free;
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
      operator_(system) {}

void ContactStage::ForgetForces() {
  warm_starts_.clear();
  candidates_of_ = kNoFactorization;
}

void ContactStage::ForgetWorld() {
  ForgetForces();
  finder_.Forget();
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
  finder_.Begin(world, x, h);
  FindCandidates();
}

void ContactStage::FindCandidates() {
  // Bodies turn, and so do the rows of their contacts.
  if (candidates_of_ != solver_->generation() || world_->num_bodies() > 0) StartAfresh();
  const TrialEnd coasting = EndOf(VectorXd::Zero(b_.size()), VectorXd::Zero(b_bodies_.size()));
  AddCandidates(finder_.Select(coasting, [&](std::uint64_t key, double gap) {
    if (is_candidate_.count(key) > 0) return false;
    if (gap < parameters_.alarm_distance) return true;
    const auto warm_start = warm_starts_.find(key);
    return warm_start != warm_starts_.end() && warm_start->second.normal > 0.0;
  }));
}

void ContactStage::StartAfresh() {
  candidates_of_ = solver_->generation();
  candidates_.clear();
  is_candidate_.clear();
  operator_.Reset(solver_->factorization(), *world_, h_);
}

TrialEnd ContactStage::EndOf(const VectorXd& dv_f, const VectorXd& dV) {
  TrialEnd end;
  end.x_W = x0_ + h_ * (v0_ + system_->Scatter(dv_f, dv_c_));
  end.dV = dV;
  end.surfaces = &world_->surfaces();
  if (world_->num_bodies() > 0) {
    surfaces_end_ = world_->SurfacesAfter(dV, h_);
    end.surfaces = &surfaces_end_;
  }
  return end;
}

/// Once a candidate, a pair stays one while the factorisation lasts: W grows and never flickers.
void ContactStage::AddCandidates(const std::vector<Contact>& contacts) {
  for (const Contact& contact : contacts) {
    is_candidate_.insert(contact.key);
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
  std::vector<Contact> contacts;
  contacts.reserve(candidates_.size());
  for (const Candidate& candidate : candidates_) contacts.push_back(candidate.contact);
  operator_.SetContacts(contacts);
}

/// Forces of all candidates, row by row.
VectorXd ContactStage::Stacked(Vector3d Candidate::*values) const {
  VectorXd stacked(operator_.num_rows());
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const ContactRows& rows = operator_.rows()[i];
    const Vector3d& value = candidates_[i].*values;
    stacked(rows.normal) = value.x();
    if (rows.has_tangents()) stacked.segment<2>(rows.tangent()) = value.tail<2>();
  }
  return stacked;
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

/// @param[in,out] y,dV On entry of the impulse, on exit with that of the forces' changes.
void ContactStage::SolveCandidates(VectorXd* y, VectorXd* dV, ContactSolution* solution,
                                   StepTimings* timings) {
  const Stopwatch stopwatch(&timings->solve);
  VectorXd delta = operator_.GapChanges(*y, *dV);
  bool has_friction = false;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Contact& contact = candidates_[i].contact;
    const ContactRows& rows = operator_.rows()[i];
    delta(rows.normal) += contact.gap;
    if (!rows.has_tangents()) continue;
    has_friction = true;
    delta.segment<2>(rows.tangent()) +=
        ConstraintOperator::Axes(contact).rightCols<2>().transpose() * contact.slip_W;
  }
  VectorXd lambda = Stacked(&Candidate::force);
  const VectorXd applied = Stacked(&Candidate::applied);
  if (!applied.isZero(0.0)) delta.noalias() -= operator_.W() * applied;
  const McpStatistics statistics =
      has_friction
          ? SolveFrictionalContacts(operator_.W(), delta, operator_.rows(), parameters_, &lambda)
          : SolveContacts(operator_.W(), delta, parameters_, &lambda);
  solution->statistics.iterations += statistics.iterations;
  solution->statistics.residual = statistics.residual;
  solution->statistics.converged = statistics.converged;
  SetForces(lambda);
  operator_.AddForces(lambda - applied, y, dV);
}

/// Makes motion and forces of the loaded contacts those of the true A.
/// @returns false if that took too many iterations.
bool ContactStage::Refine(const Impulse& impulse, ContactSolution* solution) {
  VectorXd lambda = Stacked(&Candidate::force);
  std::vector<Index> held;
  for (Index i = 0; i < lambda.size(); ++i) {
    if (lambda(i) > 0.0) held.push_back(i);
  }
  const bool converged =
      solver_->Refine(impulse.cup, *operator_.plain(), held, &solution->dv_f, &lambda);
  SetForces(lambda);
  return converged;
}

bool ContactStage::Solve(const Eigen::Matrix3Xd& load, ContactSolution* solution,
                         StepTimings* timings) {
  LoadObjects(load);
  Impulse impulse{b_ + h_ * system_->GatherFree(load), b_bodies_};
  for (std::size_t object = 0; object < pressure_on_.size(); ++object) {
    const int body = world_->BodyOf(static_cast<int>(object));
    if (body == RigidWorld::kNone) continue;
    const ObjectLoad& on_object = pressure_on_[object];
    const Vector3d arm = world_->objects()[object].X_WO.translation() - world_->CentreOfMass(body);
    impulse.bodies.segment<3>(6 * body) += h_ * on_object.force_W;
    impulse.bodies.segment<3>(6 * body + 3) +=
        h_ * (on_object.torque_W + arm.cross(on_object.force_W));
  }
  if (!SolveWithFactorization(impulse, solution, timings)) {
    const Stopwatch stopwatch(&timings->factorization);
    if (!solver_->Renew()) return false;
    FindCandidates();
    SolveWithFactorization(impulse, solution, timings);
  }
  Report(solution);
  return true;
}

/// The cavity's air pushes on the object before a point of the cup as hard as on that point.
void ContactStage::LoadObjects(const Eigen::Matrix3Xd& load) {
  pressure_on_.assign(world_->objects().size(), ObjectLoad());
  if (world_->surfaces().empty()) return;
  for (Index node = 0; node < load.cols(); ++node) {
    if (load.col(node).isZero(0.0)) continue;
    const int nearest = finder_.NearestSurface(static_cast<int>(node));
    const auto object = static_cast<std::size_t>(world_->ObjectOf(nearest));
    const Vector3d arm = x0_.col(node) - world_->objects()[object].X_WO.translation();
    pressure_on_[object].force_W -= load.col(node);
    pressure_on_[object].torque_W -= arm.cross(Vector3d(load.col(node)));
  }
}

/// @returns false if the factorisation is too old for this.
bool ContactStage::SolveWithFactorization(const Impulse& impulse, ContactSolution* solution,
                                          StepTimings* timings) {
  *solution = ContactSolution();
  solution->dv_f.setZero(impulse.cup.size());
  solution->dV.setZero(impulse.bodies.size());
  const TrialEnd coasting = EndOf(solution->dv_f, solution->dV);
  MeasureCandidates([&](std::uint64_t key) { return finder_.Ahead(key, coasting); });
  // An earlier factorisation errs by what it is asked to bridge: by less from the last forces on.
  for (Candidate& candidate : candidates_) {
    candidate.applied = solver_->current() ? Vector3d::Zero().eval() : candidate.force;
  }
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    UpdateOperator(timings);
    if (!solver_->current() && operator_.plain() == nullptr) return false;
    VectorXd y = VectorXd::Zero(impulse.cup.size());
    VectorXd dV = VectorXd::Zero(impulse.bodies.size());
    if (pass == 0) {
      const Stopwatch stopwatch(&timings->free_motion);
      Impulse with_forces = impulse;
      operator_.AddImpulses(Stacked(&Candidate::applied), &with_forces.cup, &with_forces.bodies);
      y = solver_->factorization().Eliminate(with_forces.cup);
      dV = operator_.BodyVelocities(with_forces.bodies);
    }
    SolveCandidates(&y, &dV, solution, timings);
    TrialEnd end;
    {
      const Stopwatch stopwatch(&timings->correction);
      solution->dv_f += solver_->factorization().BackSubstitute(std::move(y));
      solution->dV += dV;
      if (!solver_->current() && (pass == kMaxStalePasses || !Refine(impulse, solution))) {
        return false;
      }
      end = EndOf(solution->dv_f, solution->dV);
    }

    const Stopwatch stopwatch(&timings->narrow_phase);
    MeasureEnd(end, solution);
    solution->x_W = end.x_W;
    const double bound =
        std::min(parameters_.acceptable_residual,
                 std::max(10.0 * parameters_.tolerance, 2.0 * solution->statistics.residual));
    const std::vector<Contact> missed = finder_.Select(end, [&](std::uint64_t key, double gap) {
      return gap < parameters_.alarm_distance && is_candidate_.count(key) == 0;
    });
    const bool passed = std::any_of(missed.begin(), missed.end(),
                                    [&](const Contact& contact) { return contact.gap < -bound; });
    if (!passed && solution->error <= bound) break;
    // Forces with friction that were not found from here will not be found from a little further.
    if (!solution->statistics.converged && operator_.plain() == nullptr) break;

    MeasureCandidates([&](std::uint64_t key) { return finder_.At(key, end); });
    for (Candidate& candidate : candidates_) candidate.applied = candidate.force;
    if (passed) AddCandidates(missed);
  }
  return true;
}

void ContactStage::MeasureEnd(const TrialEnd& end, ContactSolution* solution) {
  finder_.MoveTo(end);
  const std::vector<double> nearest = finder_.Nearest(end);
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
    const Candidate& candidate = candidates_[i];
    const bool is_node = candidate.contact.num_nodes == 1;  // measured above
    const bool is_loaded = candidate.force.x() > 0.0;
    if (is_loaded || !is_node) {
      const double gap = finder_.At(candidate.contact.key, end).gap;
      solution->error = std::max(solution->error, is_loaded ? std::abs(gap) : -gap);
    }
    if (!is_loaded) {  // refined forces may pull
      const Index row = operator_.rows()[i].normal;
      solution->error = std::max(solution->error, -candidate.force.x() * operator_.W()(row, row));
    }
  }
}

void ContactStage::Report(ContactSolution* solution) const {
  solution->num_candidates = static_cast<int>(candidates_.size());
  solution->lambda.setZero(x0_.cols());
  solution->objects = pressure_on_;
  Vector3d friction_W = Vector3d::Zero();
  for (const Candidate& candidate : candidates_) {
    const Contact& contact = candidate.contact;
    const double normal_force = std::max(0.0, candidate.force.x());
    if (contact.num_nodes == 0 || normal_force == 0.0) continue;
    ++solution->num_contacts;
    for (int k = 0; k < contact.num_nodes; ++k) {
      const auto place = static_cast<std::size_t>(k);
      solution->lambda(contact.nodes[place]) += std::abs(contact.weights[place]) * normal_force;
    }
    if (contact.object == RigidWorld::kNone) continue;
    Vector3d on_cup_W = normal_force * contact.normal;
    if (contact.friction > 0.0) {
      const Vector3d tangential_W =
          ConstraintOperator::Axes(contact).rightCols<2>() * candidate.force.tail<2>();
      on_cup_W += tangential_W;
      friction_W += tangential_W;
    }
    const auto object = static_cast<std::size_t>(contact.object);
    const Vector3d arm = contact.p_W - world_->objects()[object].X_WO.translation();
    solution->objects[object].force_W -= on_cup_W;
    solution->objects[object].torque_W -= arm.cross(on_cup_W);
  }
  solution->friction_force = friction_W.norm();
}

}  // namespace vacuum_gripper_sim
