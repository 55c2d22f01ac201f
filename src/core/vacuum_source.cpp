#include "vacuum_gripper_sim/core/vacuum_source.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

constexpr double kNow = 1e-9;  // s; times that are the same but for round-off

}  // namespace

bool StepInterval::Contains(double time) const { return time > begin + kNow && time <= end + kNow; }

VacuumSource::VacuumSource(const VacuumParameters& parameters) : parameters_(parameters) {
  if (parameters_.source == VacuumSourceType::kIdealRegulator) {
    throw std::invalid_argument(
        "vacuum.source = ideal_regulator imposes a pressure, must be a source with a flow here");
  }
}

void VacuumSource::Begin(double setpoint, double h) {
  setpoint_ = setpoint;
  if (parameters_.source == VacuumSourceType::kRegulator) {
    state_.commanded_on = setpoint < 0.0;
    state_.phase = state_.commanded_on ? ValvePhase::kOn : ValvePhase::kOff;
    state_.reference_before = state_.reference;
    state_.reference = ReferenceAt(h);
  } else {
    AdvanceValve(h);
  }
}

double VacuumSource::ReferenceAt(double time) const {
  const double limit = parameters_.regulator.rate_limit;
  const double lag = parameters_.regulator.time_constant;
  const double error = setpoint_ - state_.reference_before;
  // At the limit until the lag alone is slower, exponential from there on.
  const double linear_time = std::clamp(std::abs(error) / limit - lag, 0.0, time);
  const double left = std::max(std::abs(error) - limit * linear_time, 0.0);
  const double decay = lag > 0.0 ? std::exp(-(time - linear_time) / lag) : 1.0;
  return setpoint_ - std::copysign(left * decay, error);
}

void VacuumSource::AdvanceValve(double h) {
  const VacuumValveParameters& valve = parameters_.valve;
  const bool command = setpoint_ < 0.0;
  if (command != state_.commanded_on) state_.waiting = 0.0;
  state_.commanded_on = command;

  state_.on = state_.blow_off = StepInterval{};
  const double delay = command ? valve.on_delay : valve.off_delay;
  for (double time = 0.0;;) {
    const bool follows = command == (state_.phase == ValvePhase::kOn);
    if (!follows && state_.waiting >= delay - kNow) {
      const bool blows = !command && valve.blow_off_duration > 0.0;
      state_.phase = command ? ValvePhase::kOn : blows ? ValvePhase::kBlowOff : ValvePhase::kOff;
      state_.blow_off_left = blows ? valve.blow_off_duration : 0.0;
      continue;
    }
    if (state_.phase == ValvePhase::kBlowOff && state_.blow_off_left <= kNow) {
      state_.phase = ValvePhase::kOff;
    }
    if (time >= h - kNow) break;

    // Each phase comes at most once in a step: the command is the same throughout.
    double next = h;
    if (!follows) next = std::min(next, time + delay - state_.waiting);
    if (state_.phase == ValvePhase::kBlowOff) next = std::min(next, time + state_.blow_off_left);
    if (state_.phase == ValvePhase::kOn) state_.on = {time, next};
    if (state_.phase == ValvePhase::kBlowOff) {
      state_.blow_off = {time, next};
      state_.blow_off_left -= next - time;
    }
    if (!follows) state_.waiting += next - time;
    time = next;
  }
}

double VacuumSource::VentThroughput(double p_abs) const {
  return OrificeThroughput(parameters_.valve.vent_area, parameters_.ambient_pressure, p_abs);
}

double VacuumSource::Capacity(double p_abs) const {
  if (pump_lost_) return 0.0;
  const double ambient = parameters_.ambient_pressure;
  switch (parameters_.source) {
    case VacuumSourceType::kRegulator:
      return parameters_.regulator.supply_flow * ambient;
    case VacuumSourceType::kEjector:
      return SuctionFlow(parameters_.ejector, p_abs - ambient) * ambient;
    case VacuumSourceType::kPump:
      return SuctionFlow(parameters_.pump, p_abs - ambient) * ambient;
    default:
      return 0.0;
  }
}

double VacuumSource::RegulatorThroughput(double p_abs, double time) const {
  const double supply = parameters_.regulator.supply_flow * parameters_.ambient_pressure;
  const double reference = std::max(parameters_.ambient_pressure + ReferenceAt(time), 0.0);
  const double wanted = supply * (reference - p_abs) / kRegulatorBand;
  const double vent = VentThroughput(p_abs);
  return std::clamp(wanted, std::min(vent, 0.0) - Capacity(p_abs), std::max(vent, 0.0));
}

double VacuumSource::SwitchedThroughput(double p_abs, double time) const {
  if (parameters_.source == VacuumSourceType::kEjector && pump_lost_) return VentThroughput(p_abs);
  if (state_.on.Contains(time)) return -Capacity(p_abs);
  const double blow_off = state_.blow_off.Contains(time) ? parameters_.valve.blow_off_flow : 0.0;
  return VentThroughput(p_abs) + blow_off * parameters_.ambient_pressure;
}

double VacuumSource::Throughput(double p_abs, double time) const {
  switch (parameters_.source) {
    case VacuumSourceType::kRegulator:
      return RegulatorThroughput(p_abs, time);
    case VacuumSourceType::kEjector:
    case VacuumSourceType::kPump:
      return SwitchedThroughput(p_abs, time);
    case VacuumSourceType::kVented:
      return VentThroughput(p_abs);
    default:
      return 0.0;
  }
}

bool VacuumSource::CanHold(double gauge_pressure,
                           const std::function<double(double p_abs)>& leak) const {
  const double p_abs = parameters_.ambient_pressure + gauge_pressure;
  return gauge_pressure < 0.0 && p_abs > 0.0 && leak(p_abs) < Capacity(p_abs);
}

}  // namespace vacuum_gripper_sim
