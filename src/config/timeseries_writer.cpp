#include "vacuum_gripper_sim/config/timeseries_writer.h"

#include "csv_text.h"

namespace vacuum_gripper_sim {
TimeseriesWriter::TimeseriesWriter(std::ostream* stream) : stream_(stream) {
  BeginCsv(
      "time,mount_x,mount_y,mount_z,setpoint,pressure,status,force_x,force_y,force_z,"
      "torque_x,torque_y,torque_z,contacts,cavity_area,contact_force,iterations,residual,"
      "step_ms,bottleneck_gap,cavity_volume,candidates,max_penetration,zone_0,zone_1,"
      "zone_2,zone_3,zone_4,linear_iterations,factorizations,outcome,"
      "opening_azimuth,opening_width,opening_gap,friction_force,"
      "manifold_pressure,source_flow,leak_flow,leak_area,gas_imbalance,gas_rounds",
      stream_);
}

void TimeseriesWriter::Write(const StepResult& r) {
  std::ostream& s = *stream_;
  s << r.time;
  WriteVector(r.X_WM.translation(), stream_);
  s << ',' << r.setpoint << ',' << r.gauge_pressure << ',' << static_cast<int>(r.status);
  WriteVector(r.X_WM.linear() * r.force_M, stream_);
  WriteVector(r.X_WM.linear() * r.torque_M, stream_);
  s << ',' << r.num_contacts << ',' << r.cavity_area << ',' << r.contact_force << ','
    << r.solver_iterations << ',' << r.solver_residual << ',' << 1e3 * r.timings.total << ','
    << r.bottleneck_gap << ',' << r.cavity_volume << ',' << r.num_candidates << ','
    << r.max_penetration;
  for (const std::uint32_t count : r.zone_counts) s << ',' << count;
  s << ',' << r.linear_iterations << ',' << r.factorizations << ',' << static_cast<int>(r.outcome)
    << ',' << r.opening.azimuth << ',' << r.opening.width << ',' << r.opening.largest_gap << ','
    << r.friction_force << ',' << r.manifold_pressure << ',' << r.source_flow << ',' << r.leak_flow
    << ',' << r.leak_area << ',' << r.gas_imbalance << ',' << r.gas_rounds << '\n';
}

}  // namespace vacuum_gripper_sim
