#include "vacuum_gripper_sim/core/gas_suction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "vacuum_gripper_sim/core/air_volume.h"
#include "vacuum_gripper_sim/core/cavity_size.h"
#include "vacuum_gripper_sim/core/stopwatch.h"

namespace vacuum_gripper_sim {
namespace {

/// Solves of the cups in a step, at most. A lip that snaps open leaves no pressure in balance.
constexpr int kMaxRounds = 8;
/// Part of the set-point's vacuum below which nothing is held.
constexpr double kHoldingPart = 0.1;
/// Part of it, and vacuum, by which it may be missed and still count as reached.
constexpr double kReachedPart = 0.01;
constexpr double kReached = 50.0;  // Pa
/// How much more may be missed by a vacuum that was reached and still counts as that.
constexpr double kStillReached = 2.0;
/// Vacuum from which on a passive cup holds. [Pa]
constexpr double kPassiveHolds = -100.0;
/// Openings below which columns of air say how much there is under a cup in the air. [m]
constexpr double kMouthIsNear = 3e-3;

/// Of the balance between cup and air. [Pa]
double Tolerance(double gauge_pressure) { return 1.0 + 5e-4 * std::abs(gauge_pressure); }

/// Vacuum that counts as the set-point's. [Pa]
double Reached(double setpoint) {
  return std::max((1.0 - kReachedPart) * setpoint, std::min(setpoint + kReached, 0.5 * setpoint));
}

double ReducedModulus(const Material& material) {
  return material.young_modulus / (1.0 - material.poisson_ratio * material.poisson_ratio);
}

}  // namespace

GasSuction::GasSuction(const CupArray& cups, const SimulatorParameters& parameters)
    : cups_(&cups),
      vacuum_(parameters.vacuum),
      open_gap_(*parameters.seal.open_gap),
      cavity_(cups.cavities, open_gap_, parameters.material.young_modulus),
      cavity_leak_(cups, open_gap_, ReducedModulus(parameters.material)),
      network_(vacuum_.manifold_volume,
               std::vector<CupLineParameters>(cups.mounts.size(), vacuum_.line),
               vacuum_.ambient_pressure),
      source_(vacuum_),
      leaks_(cups.mounts.size()),
      gas_cups_(cups.mounts.size()) {
  for (std::size_t cup = 0; cup < gas_cups_.size(); ++cup) {
    gas_cups_[cup].leak = [this, cup](double p_from, double p_to) {
      return leaks_[cup].Throughput(p_from, p_to);
    };
  }
}

AirMemory GasSuction::AtRest(const Eigen::Matrix3Xd& x_W, const std::vector<bool>& wet) const {
  const std::size_t num_cups = cups_->mounts.size();
  const Eigen::Matrix3Xd areas = PointAreaVectors(cups_->cavities, x_W);
  AirMemory air;
  for (std::size_t cup = 0; cup < num_cups; ++cup) {
    air.volume.push_back(
        SizeOfCavity(cups_->cavities, static_cast<int>(cup), wet, x_W, areas).volume);
  }
  air.gas = network_.AtAmbient(air.volume);
  air.compliance.assign(num_cups, 0.0);
  air.swept.assign(num_cups, false);
  air.growth.assign(num_cups, 0.0);
  air.leaks.resize(num_cups);
  air.slope.assign(num_cups, -1.0);
  air.miss.assign(num_cups, 0.0);
  return air;
}

bool GasSuction::Solve(const Eigen::Matrix3Xd& x_W, const Eigen::Isometry3d& X_WM,
                       const RigidWorld& world, double setpoint, double h, ContactStage* stage,
                       GripState* state, SuctionSolution* solution, StepTimings* timings) {
  X_WM_ = X_WM;
  cavity_.Begin(x_W);
  MeasureOpenCups(x_W, *stage, state);
  source_.set_state(state->air.source);
  source_.SetPumpLost(faults_.pump_lost);
  source_.Begin(setpoint, h);
  for (std::size_t cup = 0; cup < gas_cups_.size(); ++cup) {
    gas_cups_[cup].hose_opening = cup < faults_.cups.size() ? faults_.cups[cup].hose_opening : 1.0;
  }
  compliance_ = state->air.compliance;
  leaks_ = state->air.leaks;
  Predict(state->air, h);

  const std::vector<bool>& wet = state->classification.wet;
  searches_.clear();
  for (const double slope : state->air.slope) searches_.emplace_back(slope);
  for (flows_.rounds = 1;; ++flows_.rounds) {
    if (!cavity_.Solve(pressure_, wet, ContactStage::Accuracy::kFull, stage, solution, timings)) {
      return false;
    }
    const Stopwatch stopwatch(&timings->air);
    cavity_leak_.Measure(*stage, world, *solution, wet, cavity_.area_vectors(), faults_, &leaks_);
    MeasureVolumes(x_W, world, h, *stage, *state, solution->contact);
    SolveNetwork(state->air, h);
    if (Imbalance() <= 1.0 || flows_.rounds == kMaxRounds) break;
    tried_pressure_ = pressure_;
    tried_volume_ = volume_;
    for (std::size_t cup = 0; cup < pressure_.size(); ++cup) {
      pressure_[cup] =
          searches_[cup].Next(pressure_[cup], gas_.pressure[cup] - vacuum_.ambient_pressure);
    }
  }
  Report(setpoint, h, *solution, state);
  return true;
}

/// Pressures of the step's end if cups grow as in the last step, and leak as they did at its end.
void GasSuction::Predict(const AirMemory& air, double h) {
  const std::size_t num_cups = air.volume.size();
  pressure_.resize(num_cups);
  volume_.resize(num_cups);
  unaided_.resize(num_cups);
  for (std::size_t cup = 0; cup < num_cups; ++cup) {
    pressure_[cup] = air.gas.pressure(cup) - vacuum_.ambient_pressure;
    volume_[cup] = air.volume[cup] + air.growth[cup];
  }
  tried_pressure_ = pressure_;
  tried_volume_ = volume_;
  SolveNetwork(air, h);
  for (std::size_t cup = 0; cup < num_cups; ++cup) {
    const double of_air = gas_.pressure[cup] - vacuum_.ambient_pressure;
    // What leaks do beyond that, they did in the last step too.
    const double most = std::abs(of_air - pressure_[cup]) + Tolerance(of_air);
    unaided_[cup] = of_air;
    pressure_[cup] = of_air + std::clamp(air.miss[cup], -most, most);
  }
}

/// Whether the air in a cup is cut off: something touches its lip, or the lip floats on air that
/// can not get out.
bool GasSuction::IsClosed(std::size_t cup, const GripState& state) const {
  constexpr double kCushion = 50.0;  // Pa
  return state.cups[cup].touches || (state.cups[cup].pressure > kCushion &&
                                     state.classification.bottleneck_gaps[cup] <= open_gap_);
}

/// Of a cup that is not closed. [m^3]
double GasSuction::OpenVolume(std::size_t cup, const Eigen::Matrix3Xd& x_W,
                              const Eigen::Matrix3Xd& areas, const ContactStage& stage,
                              const Classification& classification) const {
  const int k = static_cast<int>(cup);
  if (classification.bottleneck_gaps[cup] > kMouthIsNear) {
    return SizeOfCavity(cups_->cavities, k, classification.wet, x_W, areas).volume;
  }
  const Eigen::Vector3d axis_W = (X_WM_ * cups_->mounts[cup].X_MC).linear().col(2);
  return AirVolume(cups_->cavities, k, classification.wet, x_W, areas, axis_W,
                   [&](const Eigen::Vector3d& p_W) { return stage.Distance(p_W); });
}

/// Where nothing closes a cavity it ends where the step finds it to; air beyond is the ambient's.
/// One that closed in the last step, maybe with a snap, begins with what that step left in it.
void GasSuction::MeasureOpenCups(const Eigen::Matrix3Xd& x_W, const ContactStage& stage,
                                 GripState* state) {
  AirMemory& air = state->air;
  exchanged_.assign(air.volume.size(), 0.0);
  for (std::size_t cup = 0; cup < air.volume.size(); ++cup) {
    if (IsClosed(cup, *state) && air.swept[cup]) continue;
    const double pressure = air.gas.pressure(cup);
    const double volume =
        OpenVolume(cup, x_W, cavity_.area_vectors(), stage, state->classification);
    exchanged_[cup] = pressure * (volume - std::max(air.volume[cup], 0.0));
    air.gas.amount[cup] += exchanged_[cup];
    air.gas.volume[cup] = volume + vacuum_.line.dead_volume;
    air.volume[cup] = volume;
    air.growth[cup] = 0.0;
    air.slope[cup] = -1.0;
    air.miss[cup] = 0.0;
  }
}

void GasSuction::MeasureVolumes(const Eigen::Matrix3Xd& x_W, const RigidWorld& world, double h,
                                const ContactStage& stage, const GripState& state,
                                const ContactSolution& contact) {
  const CavitySurface& surface = cups_->cavities;
  PointAreaVectors(surface, contact.x_W, &areas_end_);
  motion_W_.resize(3, surface.num_points());
  const bool objects_move = world.AnyMoves();
  for (int i = 0; i < surface.num_points(); ++i) {
    const int node = surface.nodes[static_cast<std::size_t>(i)];
    motion_W_.col(i) = contact.x_W.col(node) - x_W.col(node);
    if (!objects_move) continue;
    const int object = world.ObjectOf(stage.NearestSurface(node));
    motion_W_.col(i) -= world.Displacement(object, x_W.col(node), contact.dv.bodies, h);
  }
  for (std::size_t cup = 0; cup < volume_.size(); ++cup) {
    // Of an open cup the next step measures it: a lip that comes down does not draw air.
    volume_[cup] = state.air.volume[cup];
    if (IsClosed(cup, state)) {
      volume_[cup] += SweptVolume(surface, static_cast<int>(cup), state.classification.wet,
                                  motion_W_, cavity_.area_vectors(), areas_end_);
    }
    const double change = pressure_[cup] - tried_pressure_[cup];
    if (flows_.rounds > 1 && std::abs(change) > Tolerance(pressure_[cup])) {
      compliance_[cup] = std::max(0.0, (volume_[cup] - tried_volume_[cup]) / change);
    }
  }
}

void GasSuction::SolveNetwork(const AirMemory& air, double h) {
  for (std::size_t cup = 0; cup < gas_cups_.size(); ++cup) {
    gas_cups_[cup].volume = volume_[cup];
    gas_cups_[cup].compliance = compliance_[cup];
    gas_cups_[cup].linear_at = vacuum_.ambient_pressure + pressure_[cup];
  }
  const auto source = [this](double p_abs, double time) { return source_.Throughput(p_abs, time); };
  network_.Solve(air.gas, gas_cups_, source, source_.on(), h, &gas_);
}

/// Of the pressures that load the cups and those of their air, in tolerances.
double GasSuction::Imbalance() const {
  double worst = 0.0;
  for (std::size_t cup = 0; cup < pressure_.size(); ++cup) {
    const double of_air = gas_.pressure[cup] - vacuum_.ambient_pressure;
    worst = std::max(worst, std::abs(of_air - pressure_[cup]) / Tolerance(pressure_[cup]));
  }
  return worst;
}

void GasSuction::Report(double setpoint, double h, const SuctionSolution& solution,
                        GripState* state) {
  const double ambient = vacuum_.ambient_pressure;
  flows_.manifold_pressure = gas_.manifold_pressure - ambient;
  flows_.source_flow = -gas_.source_flow / ambient;
  const std::size_t num_cups = pressure_.size();
  flows_.leak_flow.resize(num_cups);
  flows_.leak_area.resize(num_cups);
  flows_.status.resize(num_cups);
  flows_.imbalance = 0.0;
  const bool can_hold = source_.CanHold(Reached(setpoint), [&](double p_abs) {
    double sum = 0.0;
    for (const CupLeak& leak : leaks_) sum += leak.Throughput(ambient, p_abs);
    return sum;
  });

  AirMemory& air = state->air;
  for (std::size_t cup = 0; cup < num_cups; ++cup) {
    const double of_air = gas_.pressure[cup] - ambient;
    flows_.imbalance = std::max(flows_.imbalance, std::abs(of_air - pressure_[cup]));
    flows_.leak_flow[cup] = (gas_.leak_flow[cup] + exchanged_[cup] / h) / ambient;
    // Of a cup without vacuum: what a little of it would draw.
    constexpr double kLittle = 1000.0;  // Pa
    flows_.leak_area[cup] =
        leaks_[cup].EquivalentArea(ambient, std::min(ambient - kLittle, gas_.pressure[cup]));

    air.swept[cup] = IsClosed(cup, *state);
    const double begin = state->cups[cup].pressure;
    air.growth[cup] = volume_[cup] - air.volume[cup] - compliance_[cup] * (pressure_[cup] - begin);
    air.slope[cup] = searches_[cup].slope();
    air.miss[cup] = of_air - unaided_[cup];
    // Air that the balance left over shows in the volume that goes with its pressure.
    air.volume[cup] = volume_[cup];
    state->cups[cup].pressure = pressure_[cup];
    state->cups[cup].touches =
        solution.contact.on_objects.segment(cups_->FirstNode(cup), cups_->nodes_per_cup).sum() >
        0.0;
    flows_.status[cup] = StatusOf(cup, setpoint, can_hold, solution, &state->cups[cup]);
  }
  air.gas = gas_.end;
  flows_.pressure.resize(num_cups);
  for (std::size_t cup = 0; cup < num_cups; ++cup) {
    air.gas.volume[cup] = std::max(volume_[cup], 0.0) + vacuum_.line.dead_volume;
    flows_.pressure[cup] = air.gas.pressure(cup) - ambient;
  }
  air.source = source_.state();
  air.compliance = compliance_;
  air.leaks = leaks_;
  state->classification = solution.classification;
}

SealStatus GasSuction::StatusOf(std::size_t cup, double setpoint, bool can_hold,
                                const SuctionSolution& solution, CavityState* cavity) const {
  const bool is_passive = vacuum_.source == VacuumSourceType::kPassive;
  const bool is_on = is_passive || setpoint < 0.0;
  const bool airtight = solution.classification.bottleneck_gaps[cup] <= open_gap_;
  const double vacuum_to_hold =
      is_passive ? kPassiveHolds : std::min(kHoldingPart * setpoint, -kReached);
  const bool has_vacuum = cavity->pressure <= vacuum_to_hold;
  if (!is_on) cavity->lost = false;
  if (is_passive && airtight && cavity->pressure >= 0.0) cavity->lost = false;  // pressed anew
  if (is_on && has_vacuum && (airtight || cavity->sealed)) {
    cavity->sealed = true;
    cavity->lost = false;
    if (is_passive) return airtight ? SealStatus::kSealed : SealStatus::kLeaking;
    const double missed = (Reached(setpoint) - setpoint) * (cavity->reached ? kStillReached : 1.0);
    cavity->reached = cavity->pressure <= setpoint + missed;
    if (cavity->reached) return SealStatus::kSealed;
    return can_hold ? SealStatus::kRegulating : SealStatus::kLeaking;
  }
  if (!is_on && airtight && cavity->pressure <= -kReached) return SealStatus::kRegulating;
  if (cavity->sealed && is_on) cavity->lost = true;
  cavity->sealed = cavity->reached = false;
  if (cavity->lost) return SealStatus::kLost;
  // Airtight and just begun: the vacuum is on its way.
  return is_on && !is_passive && airtight && can_hold ? SealStatus::kRegulating : SealStatus::kOpen;
}

}  // namespace vacuum_gripper_sim
