#pragma once

#include <ostream>

#include "vacuum_gripper_sim/core/step_result.h"
#include "vacuum_gripper_sim/core/vacuum_sensor.h"

namespace vacuum_gripper_sim {

/// What a sensor on the manifold has to measure. @param ambient_pressure Absolute. [Pa]
VacuumTruth ToMeasure(const StepResult& result, double ambient_pressure);

/** Writes one CSV row for every reading of the vacuum sensor: the time it was sampled, its absolute
 and gauge pressure [Pa], flow as free air [m^3/s], verdicts as 0 or 1, actual power [-]; the header
 line names the columns. */
class SensorWriter {
 public:
  /// Writes the header line. @param parameters Validated. @param ambient_pressure Absolute. [Pa]
  /// @param stream Must outlive the writer; gets the C locale.
  SensorWriter(const VacuumSensorParameters& parameters, double ambient_pressure,
               std::ostream* stream);

  /// @param stuck Fault: the sensor does not measure.
  void Write(const StepResult& result, bool stuck);

 private:
  VacuumSensor sensor_;
  double ambient_pressure_;  // Pa
  std::ostream* stream_;
};

}  // namespace vacuum_gripper_sim
