#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <random>

#include "vacuum_gripper_sim/core/gas_flow.h"

namespace vacuum_gripper_sim {

/** A vacuum switch with analogue outputs at the manifold. Levels are gauge pressures. Rate, delay,
 noise and resolution are of an order typical of compact vacuum switches; the levels suit set-points
 of -6 kPa and deeper and are past the 1.5 kPa that the default ejector leaves in its manifold with
 one cup open. */
struct VacuumSensorParameters {
  double rate{100.0};                   ///< Of samples. [Hz] > 0
  double delay{0.005};                  ///< From sample to output. [s] >= 0
  double pressure_noise{30.0};          ///< Standard deviation. [Pa] >= 0
  double flow_noise{0.0};               ///< Standard deviation, as free air. [m^3/s] >= 0
  double pressure_resolution{100.0};    ///< Readings are multiples of it; 0: any. [Pa] >= 0
  double range_min{0.0};                ///< Readings end here, absolute. [Pa] >= 0
  double range_max{200000.0};           ///< And here. [Pa] > range_min
  std::uint64_t seed{1};                ///< Of the noise.
  double part_present_level{-4000.0};   ///< [Pa] < 0
  double part_detached_level{-2000.0};  ///< [Pa] < 0, above part_present_level
  double hysteresis{500.0};             ///< [Pa] >= 0, at most the distance of the two levels
  double hold_time{0.02};               ///< For which a condition must last. [s] >= 0
};

/** Checks every number.
 @throws std::invalid_argument naming the field by its dotted YAML path (`vacuum.sensor.rate`), its
   value and what is allowed. */
void Validate(const VacuumSensorParameters& parameters);

/// What the gripper's driver would publish.
struct VacuumReading {
  double time{0.0};               ///< When it was sampled. [s]
  double absolute_pressure{0.0};  ///< [Pa]
  double flow{0.0};               ///< Evacuated, as free air. [m^3/s]
  /// While switched on: vacuum at least as deep as the set-point; until it is shallower by the
  /// hysteresis, or by half the set-point where that is less.
  bool in_control_range{false};
  /// Vacuum deeper than part_present_level, until it is shallower by the hysteresis: something
  /// covers the cups.
  bool part_present{false};
  /// Nothing is held any more: after a part was present or the gripper was switched off, the vacuum
  /// became shallower than part_detached_level; until it is deeper by the hysteresis. False before
  /// the first grip.
  bool part_detached{false};
  double actual_power{0.0};  ///< Depth of the vacuum, 0 ambient to 1 none left. [-]
  bool is_new{false};        ///< Whether this reading came out in this very step.
};

/// What there is to measure in a step.
struct VacuumTruth {
  double time{0.0};               ///< Of the step's end. [s]
  double absolute_pressure{0.0};  ///< Of the manifold. [Pa]
  double flow{0.0};               ///< Evacuated, as free air. [m^3/s]
  double setpoint{0.0};           ///< Gauge. [Pa]
  bool on{false};                 ///< As commanded.
};

/// A condition that counts once it has lasted.
class HeldCondition {
 public:
  /// @param time [s] @param hold_time [s] @returns the condition as held.
  bool Update(bool condition, double time, double hold_time);
  bool value() const { return value_; }

 private:
  bool value_{false};
  std::optional<double> differs_since_;  // s
};

/** Reads the vacuum as a device would: a sample at the first step whose time is not before that of
 the sensor's own clock (at most one a step), with noise, rounded to the resolution and cut to the
 range; the verdicts from the samples, each switched after its condition lasted for the hold time;
 all of it put out after the delay. Between samples the last reading stands. */
class VacuumSensor {
 public:
  /// @param parameters Validated. @param ambient_pressure Absolute. [Pa]
  explicit VacuumSensor(const VacuumSensorParameters& parameters,
                        double ambient_pressure = air::kAmbientPressure);

  /// Called once a step with times that do not fall. @returns the reading at that time; before the
  /// first has come out, ambient pressure and no verdict.
  const VacuumReading& Update(const VacuumTruth& truth);

  /// Fault: the output stays as it is until cleared, with is_new false.
  void SetStuck(bool stuck) { stuck_ = stuck; }
  bool stuck() const { return stuck_; }

  const VacuumReading& reading() const { return reading_; }

  /// As constructed, the noise's seed included; a fault stays.
  void Reset();

 private:
  VacuumReading Sample(const VacuumTruth& truth);
  double StandardNormal();

  VacuumSensorParameters parameters_;
  double ambient_pressure_;
  bool stuck_{false};
  std::mt19937_64 random_;
  std::optional<double> first_time_;  // of the sensor's clock [s]
  std::int64_t num_samples_{0};
  HeldCondition in_control_range_;
  HeldCondition part_present_;
  HeldCondition part_detached_;
  bool may_detach_{false};  // gripped or released since the start
  bool was_on_{false};
  std::deque<VacuumReading> pending_;  // sampled, not yet put out
  VacuumReading reading_;
};

}  // namespace vacuum_gripper_sim
