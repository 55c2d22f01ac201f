#include "vacuum_gripper_sim/config/sensor_writer.h"

#include "csv_text.h"

namespace vacuum_gripper_sim {

VacuumTruth ToMeasure(const StepResult& result, double ambient_pressure) {
  VacuumTruth truth;
  truth.time = result.time;
  truth.absolute_pressure = ambient_pressure + result.manifold_pressure;
  truth.flow = result.source_flow;
  truth.setpoint = result.setpoint;
  truth.on = result.setpoint < 0.0;
  return truth;
}

SensorWriter::SensorWriter(const VacuumSensorParameters& parameters, double ambient_pressure,
                           std::ostream* stream)
    : sensor_(parameters, ambient_pressure), ambient_pressure_(ambient_pressure), stream_(stream) {
  BeginCsv(
      "time,absolute_pressure,gauge_pressure,flow,in_control_range,part_present,part_detached,"
      "actual_power",
      stream_);
}

void SensorWriter::Write(const StepResult& result, bool stuck) {
  sensor_.SetStuck(stuck);
  const VacuumReading& reading = sensor_.Update(ToMeasure(result, ambient_pressure_));
  if (!reading.is_new) return;
  *stream_ << reading.time << ',' << reading.absolute_pressure << ','
           << reading.absolute_pressure - ambient_pressure_ << ',' << reading.flow << ','
           << reading.in_control_range << ',' << reading.part_present << ','
           << reading.part_detached << ',' << reading.actual_power << '\n';
}

}  // namespace vacuum_gripper_sim
