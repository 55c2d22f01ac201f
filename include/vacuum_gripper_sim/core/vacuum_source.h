#pragma once

#include <functional>

#include "vacuum_gripper_sim/core/vacuum_parameters.h"

namespace vacuum_gripper_sim {

/// What the valve of an ejector or a pump does.
enum class ValvePhase { kOff, kOn, kBlowOff };

/// Part of a step, in time since its start. [s]
struct StepInterval {
  double begin{0.0};
  double end{0.0};
  /// Whether it holds the time and what comes just before it; intervals that meet share no time.
  bool Contains(double time) const;
};

/// What a source remembers; copying it back undoes a step.
struct VacuumSourceState {
  ValvePhase phase{ValvePhase::kOff};  ///< At the end of the step begun last.
  bool commanded_on{false};
  double waiting{0.0};           ///< Since the command that the valve has not yet followed. [s]
  double blow_off_left{0.0};     ///< Of the pulse. [s]
  double reference_before{0.0};  ///< Of the regulator at the step's start, gauge. [Pa]
  double reference{0.0};         ///< At its end. [Pa]
  StepInterval on;               ///< Of the step begun last; besides these two it is off.
  StepInterval blow_off;
};

/** Source of vacuum at the manifold's port: the air that enters it at the pressure it has there.

 - Regulator: its reference r follows the set-point by dr/dt = clamp((s - r) / tau, +-rate),
   integrated exactly; a steep valve moves what is needed to hold it, within the supply's flow one
   way and the vent's the other. Its full flow takes kRegulatorBand of deviation. The valve's delays
   and its blow-off do not concern it.
 - Ejector and pump: full suction along their curve while the valve is on, whatever the set-point.
   Off: the vent. Blow-off: compressed air besides the vent, which bounds the overpressure.
 - Passive: nothing passes. Vented: the vent, always.

 A command counts only if it lasts for the valve's delay: one that is revoked before has no effect.
 Delays are times and may end within a step.

 With the supply lost, an ejector has neither suction nor blow-off: air comes back through nozzle
 and silencer at any set-point. A pump that stops is closed by its own valves, until it is switched
 off and vented. A regulator can only vent. */
class VacuumSource {
 public:
  static constexpr double kRegulatorBand = 20.0;  ///< [Pa]

  /** @param parameters Validated.
   @throws std::invalid_argument for kIdealRegulator, which no flow describes. */
  explicit VacuumSource(const VacuumParameters& parameters);

  /// Begins a step of length h [s] with a set-point: gauge, 0 is off. [Pa] <= 0
  void Begin(double setpoint, double h);

  /// Fault: the supply of compressed air or vacuum, or the pump's drive, is gone.
  void SetPumpLost(bool lost) { pump_lost_ = lost; }
  bool pump_lost() const { return pump_lost_; }

  /** Throughput into the manifold at a time within the step: a continuous function that never rises
   with the manifold's pressure and is not negative at p_abs = 0. [Pa m^3/s]
   @param p_abs Of the manifold, absolute. [Pa] @param time Since the step's start. [s] > 0, <= h */
  double Throughput(double p_abs, double time) const;

  /// Most that the source could evacuate at this pressure when on, without regard to a set-point.
  /// [Pa m^3/s] >= 0
  double Capacity(double p_abs) const;

  /** Whether the source, switched on, can hold a vacuum against a leak: that takes out more than
   comes in there. A closed port takes out nothing and never can.
   @param gauge_pressure Of the vacuum; without any, at 0 Pa, none is held. [Pa]
   @param leak Throughput into the cavity at its absolute pressure. [Pa m^3/s] */
  bool CanHold(double gauge_pressure, const std::function<double(double p_abs)>& leak) const;

  /// Whether the source draws at the step's end, as its valve is; pilots check valves.
  bool on() const { return state_.phase == ValvePhase::kOn; }
  double setpoint() const { return setpoint_; }  ///< Of the step begun last, gauge. [Pa]

  const VacuumSourceState& state() const { return state_; }
  void set_state(const VacuumSourceState& state) { state_ = state; }

 private:
  void AdvanceValve(double h);
  double ReferenceAt(double time) const;
  double VentThroughput(double p_abs) const;
  double RegulatorThroughput(double p_abs, double time) const;
  double SwitchedThroughput(double p_abs, double time) const;

  VacuumParameters parameters_;
  VacuumSourceState state_;
  double setpoint_{0.0};
  bool pump_lost_{false};
};

}  // namespace vacuum_gripper_sim
