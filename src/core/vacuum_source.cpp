#include "vacuum_gripper_sim/core/vacuum_source.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vacuum_gripper_sim {

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
    AdvanceReference(h);
  } else {
    AdvanceValve(h);
  }
}

void VacuumSource::AdvanceReference(double h) {
  const double limit = parameters_.regulator.rate_limit;
  const double lag = parameters_.regulator.time_constant;
  const double error = setpoint_ - state_.reference;
  // At the limit until the lag alone is slower, exponential from there on.
  const double linear_time = std::clamp(std::abs(error) / limit - lag, 0.0, h);
  const double left = std::max(std::abs(error) - limit * linear_time, 0.0);
  const double decay =
      lag > 0.0 ? std::exp(-(h - linear_time) / lag) : (linear_time < h ? 0.0 : 1.0);
  state_.reference = setpoint_ - std::copysign(left * decay, error);
}

void VacuumSource::AdvanceValve(double h) {
  const VacuumValveParameters& valve = parameters_.valve;
  const bool command = setpoint_ < 0.0;
  if (command != state_.commanded_on) state_.waiting = 0.0;
  state_.commanded_on = command;

  constexpr double kNow = 1e-12;  // s; steps add up to a delay but for round-off
  double on_time = 0.0;
  double blow_off_time = 0.0;
  for (double left = h;;) {
    const bool is_on = state_.phase == ValvePhase::kOn;
    if (command != is_on) {
      const double delay = command ? valve.on_delay : valve.off_delay;
      if (state_.waiting >= delay - kNow) {
        const bool blows = !command && valve.blow_off_duration > 0.0;
        state_.phase = command ? ValvePhase::kOn : blows ? ValvePhase::kBlowOff : ValvePhase::kOff;
        state_.blow_off_left = blows ? valve.blow_off_duration : 0.0;
        continue;
      }
    }
    if (state_.phase == ValvePhase::kBlowOff && state_.blow_off_left <= kNow) {
      state_.phase = ValvePhase::kOff;
    }
    if (left <= kNow) break;

    double interval = left;  // to the next event
    if (command != is_on) {
      interval = std::min(interval, (command ? valve.on_delay : valve.off_delay) - state_.waiting);
    }
    if (state_.phase == ValvePhase::kBlowOff) {
      interval = std::min(interval, state_.blow_off_left);
      state_.blow_off_left -= interval;
      blow_off_time += interval;
    }
    if (is_on) on_time += interval;
    if (command != is_on) state_.waiting += interval;
    left -= interval;
  }
  state_.on_share = std::min(on_time / h, 1.0);
  state_.blow_off_share = std::min(blow_off_time / h, 1.0 - state_.on_share);
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

double VacuumSource::RegulatorThroughput(double p_abs) const {
  const double supply = parameters_.regulator.supply_flow * parameters_.ambient_pressure;
  const double reference = std::max(parameters_.ambient_pressure + state_.reference, 0.0);
  const double wanted = supply * (reference - p_abs) / kRegulatorBand;
  const double vent = VentThroughput(p_abs);
  return std::clamp(wanted, std::min(vent, 0.0) - Capacity(p_abs), std::max(vent, 0.0));
}

double VacuumSource::SwitchedThroughput(double p_abs) const {
  const bool is_ejector = parameters_.source == VacuumSourceType::kEjector;
  const double on = state_.on_share;
  const double blow_off = is_ejector && pump_lost_ ? 0.0 : state_.blow_off_share;
  const double vented = is_ejector && pump_lost_ ? 1.0 : 1.0 - on;
  return vented * VentThroughput(p_abs) - on * Capacity(p_abs) +
         blow_off * parameters_.valve.blow_off_flow * parameters_.ambient_pressure;
}

double VacuumSource::Throughput(double p_abs) const {
  switch (parameters_.source) {
    case VacuumSourceType::kRegulator:
      return RegulatorThroughput(p_abs);
    case VacuumSourceType::kEjector:
    case VacuumSourceType::kPump:
      return SwitchedThroughput(p_abs);
    case VacuumSourceType::kVented:
      return VentThroughput(p_abs);
    default:
      return 0.0;
  }
}

bool VacuumSource::CanHold(const std::function<double(double p_abs)>& leak) const {
  const double p_abs = parameters_.ambient_pressure + setpoint_;
  return setpoint_ < 0.0 && p_abs > 0.0 && leak(p_abs) < Capacity(p_abs);
}

}  // namespace vacuum_gripper_sim
