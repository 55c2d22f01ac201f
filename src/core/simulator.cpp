#include "vacuum_gripper_sim/core/simulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "vacuum_gripper_sim/core/cavity_size.h"
#include "vacuum_gripper_sim/core/contact_stage.h"
#include "vacuum_gripper_sim/core/elastic_body.h"
#include "vacuum_gripper_sim/core/gas_suction.h"
#include "vacuum_gripper_sim/core/implicit_euler.h"
#include "vacuum_gripper_sim/core/linear_solver.h"
#include "vacuum_gripper_sim/core/misplacement.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/seal_tolerance.h"
#include "vacuum_gripper_sim/core/stopwatch.h"
#include "vacuum_gripper_sim/core/suction.h"

namespace vacuum_gripper_sim {
namespace {

/// The nodes of the whole boundary, ascending.
std::vector<int> SurfaceNodes(const TetMesh& mesh) {
  std::vector<int> nodes(mesh.boundary_faces.data(),
                         mesh.boundary_faces.data() + mesh.boundary_faces.size());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

SimulatorParameters WithSealGaps(SimulatorParameters parameters, const CupArray& cups) {
  parameters.seal = ResolveSealGaps(parameters.seal, LipSagitta(cups.cavities, cups.mesh.nodes));
  return parameters;
}

/// What a step changes and an undone step gives back.
struct State {
  Eigen::Matrix3Xd x_W;  // positions, 3 by #nodes [m]
  Eigen::Matrix3Xd v_W;  // velocities, 3 by #nodes [m/s]
  GripState grip;
};

SealStatus StatusOf(const CavityState& cavity, double setpoint) {
  if (!cavity.sealed) return cavity.lost ? SealStatus::kLost : SealStatus::kOpen;
  return cavity.pressure == setpoint ? SealStatus::kSealed : SealStatus::kRegulating;
}

}  // namespace

class Simulator::Implementation {
 public:
  Implementation(const TetMesh& mesh, const SimulatorParameters& parameters,
                 const Eigen::Isometry3d& X_WM)
      : cups_(MakeCupArray(mesh, parameters.cups)),
        parameters_(WithSealGaps(parameters, cups_)),
        body_(cups_.mesh, parameters.material),
        system_(body_, cups_.mesh.mount_nodes),
        solver_(parameters.linear_solver, &system_),
        stage_(cups_.mesh, system_, &solver_, SurfaceNodes(cups_.mesh), parameters.contact),
        suction_(cups_.cavities, parameters_.seal, parameters.regulator,
                 parameters.material.young_modulus) {
    if (parameters.vacuum.source != VacuumSourceType::kIdealRegulator) {
      gas_suction_ = std::make_unique<GasSuction>(cups_, parameters_);
    }
    Reset(X_WM);
  }

  void SetObjects(std::vector<RigidObject> objects);
  void SetObjectPose(int index, const Eigen::Isometry3d& X_WO);
  void SetFaults(const VacuumFaults& faults);
  Snapshot Save() const;
  void Restore(const Snapshot& snapshot);
  void Reset(const Eigen::Isometry3d& X_WM);
  void Step(const Command& command);
  std::vector<std::thread::native_handle_type> HelperThreads() {
    return solver_.crew().HelperThreads();
  }

  // Neither moved nor copied: parts below point at each other.
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() = default;

  CupArray cups_;
  SimulatorParameters parameters_;
  RigidWorld world_;
  StepResult result_;

 private:
  std::vector<double> ClassifyAtRest();
  void FindClampedVelocityChange(const Eigen::Isometry3d& X_WM);
  bool Advance(const Command& command);
  bool SolveSuction(const Command& command);
  std::string DescribeMisplacement() const;
  void ReportWrenches();
  void ReportContacts();
  void ReportAir();
  void ReportCups();
  void ReportObjects(const std::vector<ObjectLoad>& loads);

  ElasticBody body_;
  ImplicitEuler system_;
  LinearSolver solver_;
  ContactStage stage_;
  Suction suction_;
  std::unique_ptr<GasSuction> gas_suction_;  // instead of suction_ where the source flows
  State state_;
  State last_good_;  // that an undone step goes back to

  // Of the last step.
  Eigen::Matrix3Xd dv_c_;     // of the clamped nodes [m/s]
  Eigen::VectorXd b_bodies_;  // of the free bodies' motion [N s], [N m s]
  SuctionSolution solution_;
  Eigen::Matrix3Xd dv_W_;             // of all nodes [m/s]
  Eigen::Matrix3Xd area_vectors_;     // of the cavity points at its end [m^2]
  std::vector<ObjectLoad> on_mount_;  // of each cup, about the mount's origin
  bool free_ones_placed_{false};      // since the last good step
};

void Simulator::Implementation::SetObjects(std::vector<RigidObject> objects) {
  world_.SetObjects(std::move(objects));
  free_ones_placed_ = true;
  stage_.ForgetWorld();
  // What a grip at work knows of its cavities comes from its forces.
  const auto touches = [](const CavityState& cavity) { return cavity.touches; };
  if (std::none_of(state_.grip.cups.begin(), state_.grip.cups.end(), touches)) ClassifyAtRest();
  ReportObjects(std::vector<ObjectLoad>(world_.objects().size()));
}

void Simulator::Implementation::SetObjectPose(int index, const Eigen::Isometry3d& X_WO) {
  world_.SetPose(index, X_WO);
  if (world_.BodyOf(index) == RigidWorld::kNone) return;  // it was moved: points keep their sides
  free_ones_placed_ = true;
  stage_.ForgetWorld();
}

void Simulator::Implementation::SetFaults(const VacuumFaults& faults) {
  Validate(faults, cups_.mounts.size(), world_.objects().size());
  if (gas_suction_) gas_suction_->SetFaults(faults);
}

/// By the distances of the cavity points alone. @returns them. [m]
std::vector<double> Simulator::Implementation::ClassifyAtRest() {
  std::vector<double> gap = NearestDistances(world_.surfaces(), cups_.cavities.nodes, state_.x_W);
  state_.grip.classification = Classify(cups_.cavities, gap, *parameters_.seal.open_gap);
  return gap;
}

void Simulator::Implementation::Reset(const Eigen::Isometry3d& X_WM) {
  state_.x_W = X_WM * cups_.rest_M;
  state_.v_W = Eigen::Matrix3Xd::Zero(3, cups_.rest_M.cols());
  state_.grip = GripState();
  state_.grip.cups.resize(cups_.mounts.size());
  stage_.ForgetWorld();

  const double time = result_.time;
  result_ = StepResult();
  result_.time = time;
  result_.X_WM = X_WM;
  result_.x_W = state_.x_W;
  result_.gap = ClassifyAtRest();
  result_.classification = state_.grip.classification;
  if (gas_suction_) {
    state_.grip.air = gas_suction_->AtRest(state_.x_W, result_.classification.wet);
    result_.gas_amount = state_.grip.air.gas.total_amount();
  }
  result_.cups.assign(cups_.mounts.size(), CupResult());
  ReportCups();
  ReportObjects(std::vector<ObjectLoad>(world_.objects().size()));
}

Snapshot Simulator::Implementation::Save() const {
  Snapshot snapshot;
  snapshot.time = result_.time;
  snapshot.command = {result_.X_WM, result_.setpoint};
  snapshot.x_W = state_.x_W;
  snapshot.v_W = state_.v_W;
  snapshot.grip = state_.grip;
  if (gas_suction_) snapshot.faults = gas_suction_->faults();
  snapshot.objects = world_.objects();
  for (std::size_t i = 0; i < snapshot.objects.size(); ++i) {
    snapshot.objects[i].velocity_W = result_.objects[i].velocity_W;
    snapshot.objects[i].angular_velocity_W = result_.objects[i].angular_velocity_W;
  }
  return snapshot;
}

void Simulator::Implementation::Restore(const Snapshot& snapshot) {
  if (snapshot.x_W.cols() != cups_.mesh.nodes.cols() ||
      snapshot.grip.cups.size() != cups_.mounts.size()) {
    std::ostringstream message;
    message << "the snapshot has " << snapshot.x_W.cols() << " nodes and "
            << snapshot.grip.cups.size()
            << " cups, must have those of the simulator: " << cups_.mesh.nodes.cols() << " and "
            << cups_.mounts.size();
    throw std::invalid_argument(message.str());
  }
  SetObjects(snapshot.objects);
  SetFaults(snapshot.faults);
  Reset(snapshot.command.X_WM);
  result_.time = snapshot.time;
  result_.setpoint = snapshot.command.pressure_setpoint;
  state_ = {snapshot.x_W, snapshot.v_W, snapshot.grip};
}

/// The mount's nodes end the step where the commanded pose puts them.
void Simulator::Implementation::FindClampedVelocityChange(const Eigen::Isometry3d& X_WM) {
  const std::vector<int>& clamped = system_.clamped_nodes();
  dv_c_.resize(3, static_cast<Eigen::Index>(clamped.size()));
  for (std::size_t i = 0; i < clamped.size(); ++i) {
    const int node = clamped[i];
    const Eigen::Vector3d target_W = X_WM * cups_.rest_M.col(node);
    dv_c_.col(static_cast<Eigen::Index>(i)) =
        (target_W - state_.x_W.col(node)) / parameters_.time_step - state_.v_W.col(node);
  }
}

void Simulator::Implementation::Step(const Command& command) {
  last_good_ = state_;
  result_.timings = StepTimings();
  result_.outcome = StepOutcome::kOk;
  result_.message.clear();
  bool done = false;
  {
    const Stopwatch stopwatch(&result_.timings.total);
    done = Advance(command);
  }
  if (!done) {
    std::swap(state_, last_good_);
    stage_.ForgetForces();
  }
  result_.time += parameters_.time_step;
}

/// What was put where no motion of a step can answer it; empty if nothing was.
std::string Simulator::Implementation::DescribeMisplacement() const {
  const std::string jump = DescribeJump(world_, cups_.cavities.nodes, state_.x_W);
  return jump.empty() && free_ones_placed_ ? DescribeOverlap(world_) : jump;
}

/// One step h, item by item as [Bernardin, Sec. III-A]. False: the result says why, undo it.
bool Simulator::Implementation::Advance(const Command& command) {
  const double h = parameters_.time_step;
  StepTimings* const timings = &result_.timings;
  const auto fail = [&](StepOutcome outcome, const std::string& message) {
    result_.outcome = outcome;
    result_.message = message;
    return false;
  };
  if (!IsRigidMotion(command.X_WM)) {
    return fail(StepOutcome::kNonFinite, "the commanded mount pose is not a finite rigid motion");
  }
  if (!(command.pressure_setpoint <= 0.0 &&
        command.pressure_setpoint >= parameters_.regulator.min_pressure)) {
    return fail(StepOutcome::kNonFinite, "the set-point is not in [regulator.min_pressure, 0] Pa");
  }

  const std::string misplacement = DescribeMisplacement();
  if (!misplacement.empty()) return fail(StepOutcome::kUnconverged, misplacement);

  // 1) Free motion: equation (2) with lambda = 0.
  FindClampedVelocityChange(command.X_WM);
  {
    const Stopwatch stopwatch(&timings->assembly);
    system_.Linearize(state_.x_W, state_.v_W, h, parameters_.damping, parameters_.gravity,
                      &solver_.crew());
  }
  {
    const Stopwatch stopwatch(&timings->factorization);
    if (!solver_.Compute()) {
      return fail(StepOutcome::kNonFinite, "A is not positive definite");
    }
  }
  const Eigen::VectorXd& b = system_.FreeRightHandSide(dv_c_);
  if (!b.allFinite()) return fail(StepOutcome::kNonFinite, "the free motion is not finite");

  // 2) to 4) Classification, constraint directions, W and the mixed complementarity problem.
  const ContactSolution& contact = solution_.contact;
  world_.FreeImpulse(parameters_.gravity, h, &b_bodies_);
  stage_.Begin(world_, state_.x_W, state_.v_W, b, dv_c_, b_bodies_, h);
  if (!SolveSuction(command)) {
    return fail(StepOutcome::kNonFinite, "A is not positive definite");
  }
  if (!contact.x_W.allFinite() || !contact.dv.bodies.allFinite()) {
    return fail(StepOutcome::kNonFinite, "the corrected motion is not finite");
  }
  result_.solver_iterations = contact.statistics.iterations;
  result_.solver_residual = contact.statistics.residual;
  const double missed = std::max(contact.error, contact.statistics.residual);
  if (!(missed <= parameters_.contact.acceptable_residual)) {
    std::ostringstream message;
    message << "contact error " << missed << " m is above contact.acceptable_residual = "
            << parameters_.contact.acceptable_residual << " m";
    return fail(StepOutcome::kUnconverged, message.str());
  }

  // 5) Motion correction.
  system_.Scatter(contact.dv.cup, dv_c_, &dv_W_);
  state_.v_W += dv_W_;
  state_.x_W = contact.x_W;
  world_.Advance(contact.dv.bodies, h);
  free_ones_placed_ = false;

  const Stopwatch stopwatch(&timings->correction);
  result_.X_WM = command.X_WM;
  result_.setpoint = command.pressure_setpoint;
  ReportWrenches();
  ReportContacts();
  ReportCups();
  ReportObjects(contact.objects);
  return true;
}

bool Simulator::Implementation::SolveSuction(const Command& command) {
  const double h = parameters_.time_step;
  StepTimings* const timings = &result_.timings;
  return gas_suction_
             ? gas_suction_->Solve(state_.x_W, command.X_WM, world_, command.pressure_setpoint, h,
                                   &stage_, &state_.grip, &solution_, timings)
             : suction_.Solve(state_.x_W, command.pressure_setpoint, h, &stage_, &state_.grip,
                              &solution_, timings);
}

/// Forces of the cups on their mounts: what holds the clamped nodes, turned round. See
/// ImplicitEuler.
void Simulator::Implementation::ReportWrenches() {
  const Eigen::Matrix3Xd& reaction = system_.ClampedReaction(solution_.contact.dv.cup, dv_c_);
  on_mount_.assign(cups_.mounts.size(), ObjectLoad());
  const Eigen::Vector3d origin_W = result_.X_WM.translation();
  for (Eigen::Index i = 0; i < reaction.cols(); ++i) {
    const int node = system_.clamped_nodes()[static_cast<std::size_t>(i)];
    // Pressure loads clamped rows too, and so do contacts with faces that have clamped corners.
    const Eigen::Vector3d on_mount_W =
        solution_.load.col(node) + solution_.contact.forces_W.col(node) - reaction.col(i);
    ObjectLoad& of_cup = on_mount_[static_cast<std::size_t>(cups_.CupOfNode(node))];
    of_cup.force_W += on_mount_W;
    of_cup.torque_W += (state_.x_W.col(node) - origin_W).cross(on_mount_W);
  }
  Eigen::Vector3d sum_W = Eigen::Vector3d::Zero(), torque_sum_W = Eigen::Vector3d::Zero();
  for (std::size_t cup = 0; cup < on_mount_.size(); ++cup) {
    const auto& [force_W, torque_W] = on_mount_[cup];
    CupResult& result = result_.cups[cup];
    result.X_WC = result_.X_WM * cups_.mounts[cup].X_MC;
    const Eigen::Matrix3d R_CW = result.X_WC.linear().transpose();
    result.force_C = R_CW * force_W;
    result.torque_C = R_CW * (torque_W - (result.X_WC.translation() - origin_W).cross(force_W));
    sum_W += force_W;
    torque_sum_W += torque_W;
  }
  const Eigen::Matrix3d R_MW = result_.X_WM.linear().transpose();
  result_.force_M = R_MW * sum_W;
  result_.torque_M = R_MW * torque_sum_W;
}

void Simulator::Implementation::ReportContacts() {
  const ContactSolution& contact = solution_.contact;
  result_.x_W = state_.x_W;
  result_.classification = solution_.classification;
  for (std::size_t i = 0; i < cups_.cavities.nodes.size(); ++i) {
    result_.gap[i] = contact.distance[static_cast<std::size_t>(cups_.cavities.nodes[i])];
  }
  result_.fold_force = contact.fold_force;
  result_.friction_force = contact.friction_force;
  result_.num_candidates = static_cast<std::uint32_t>(contact.num_candidates);
  result_.max_penetration = contact.max_penetration;
  result_.linear_iterations = solver_.iterations();
  result_.factorizations = solver_.factorizations();

  for (std::size_t cup = 0; cup < result_.cups.size(); ++cup) {
    CupResult& result = result_.cups[cup];
    const CavityState& cavity = state_.grip.cups[cup];
    result.status = StatusOf(cavity, result_.setpoint);
    result.gauge_pressure = cavity.pressure;
    result.contact_force =
        contact.on_objects.segment(cups_.FirstNode(cup), cups_.nodes_per_cup).sum();
    result.num_contacts = 0;
  }
  if (gas_suction_) ReportAir();
  for (const int node : contact.contact_nodes) {
    ++result_.cups[static_cast<std::size_t>(cups_.CupOfNode(node))].num_contacts;
  }
}

void Simulator::Implementation::ReportAir() {
  const AirFlows& flows = gas_suction_->flows();
  result_.manifold_pressure = flows.manifold_pressure;
  result_.source_flow = flows.source_flow;
  result_.gas_imbalance = flows.imbalance;
  result_.gas_rounds = flows.rounds;
  result_.gas_amount = state_.grip.air.gas.total_amount();
  for (std::size_t cup = 0; cup < result_.cups.size(); ++cup) {
    result_.cups[cup].status = flows.status[cup];
    result_.cups[cup].gauge_pressure = flows.pressure[cup];
    result_.cups[cup].leak_flow = flows.leak_flow[cup];
    result_.cups[cup].leak_area = flows.leak_area[cup];
  }
}

/// What the shape of the cups says, and the gripper's sums.
void Simulator::Implementation::ReportCups() {
  PointAreaVectors(cups_.cavities, state_.x_W, &area_vectors_);
  for (std::size_t cup = 0; cup < result_.cups.size(); ++cup) {
    CupResult& result = result_.cups[cup];
    const int k = static_cast<int>(cup);
    result.X_WC = result_.X_WM * cups_.mounts[cup].X_MC;
    result.bottleneck_gap = result_.classification.bottleneck_gaps[cup];
    result.opening = FindSealOpening(cups_.cavities, k, result_.gap, result_.classification,
                                     *parameters_.seal.open_gap, state_.x_W, result.X_WC);
    const CavitySize size =
        SizeOfCavity(cups_.cavities, k, result_.classification.wet, state_.x_W, area_vectors_);
    result.cavity_area = std::abs(size.area_W.dot(result.X_WC.linear().col(2)));
    result.cavity_volume = gas_suction_ ? std::max(state_.grip.air.volume[cup], 0.0) : size.volume;
    result.zone_counts = CountZones(cups_.cavities, k, result_.classification.zones);
  }
  static_cast<GripSummary&>(result_) = SumOf(result_.cups);
  if (!gas_suction_) result_.manifold_pressure = result_.gauge_pressure;
}

void Simulator::Implementation::ReportObjects(const std::vector<ObjectLoad>& loads) {
  result_.objects.resize(loads.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    ObjectResult& object = result_.objects[i];
    object.X_WO = world_.objects()[i].X_WO;
    object.force_W = loads[i].force_W;
    object.torque_W = loads[i].torque_W;
    const int body = world_.BodyOf(static_cast<int>(i));
    if (body == RigidWorld::kNone) continue;
    const RigidWorld::Vector6d V = world_.velocity(body);
    object.angular_velocity_W = V.tail<3>();
    object.velocity_W = V.head<3>() + object.angular_velocity_W.cross(object.X_WO.translation() -
                                                                      world_.CentreOfMass(body));
  }
}

Simulator::Simulator(const TetMesh& mesh, const SimulatorParameters& parameters,
                     const Eigen::Isometry3d& X_WM) {
  Validate(parameters);
  if (!IsRigidMotion(X_WM)) {
    throw std::invalid_argument("the mount's initial pose is not a finite rigid motion");
  }
  implementation_ = std::make_unique<Implementation>(mesh, parameters, X_WM);
}

Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

void Simulator::SetObjects(std::vector<RigidObject> objects) {
  implementation_->SetObjects(std::move(objects));
}

const std::vector<RigidObject>& Simulator::objects() const {
  return implementation_->world_.objects();
}

void Simulator::SetFaults(const VacuumFaults& faults) { implementation_->SetFaults(faults); }

void Simulator::SetObjectPose(int index, const Eigen::Isometry3d& X_WO) {
  implementation_->SetObjectPose(index, X_WO);
}

const StepResult& Simulator::Step(const Command& command) {
  implementation_->Step(command);
  return implementation_->result_;
}

void Simulator::Reset(const Eigen::Isometry3d& X_WM) {
  if (!IsRigidMotion(X_WM)) {
    throw std::invalid_argument("the mount's pose at reset is not a finite rigid motion");
  }
  implementation_->Reset(X_WM);
}

std::vector<std::thread::native_handle_type> Simulator::HelperThreads() {
  return implementation_->HelperThreads();
}

Snapshot Simulator::Save() const { return implementation_->Save(); }

void Simulator::Restore(const Snapshot& snapshot) { implementation_->Restore(snapshot); }

const StepResult& Simulator::result() const { return implementation_->result_; }
const CupArray& Simulator::cups() const { return implementation_->cups_; }
const TetMesh& Simulator::mesh() const { return implementation_->cups_.mesh; }
const CavitySurface& Simulator::cavity() const { return implementation_->cups_.cavities; }
const SimulatorParameters& Simulator::parameters() const { return implementation_->parameters_; }

}  // namespace vacuum_gripper_sim
