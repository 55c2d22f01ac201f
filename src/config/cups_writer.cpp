#include "vacuum_gripper_sim/config/cups_writer.h"

#include <cstddef>

#include "csv_text.h"

namespace vacuum_gripper_sim {

CupsWriter::CupsWriter(const std::vector<CupMount>& cups, std::ostream* stream) : stream_(stream) {
  names_.reserve(cups.size());
  for (const CupMount& cup : cups) names_.push_back(CsvCell(cup.name));
  BeginCsv(
      "time,name,status,pressure,cavity_area,contact_force,contacts,force_x,force_y,force_z,"
      "torque_x,torque_y,torque_z,bottleneck_gap,opening_azimuth,opening_width,opening_gap,"
      "cavity_volume,leak_flow,leak_area",
      stream_);
}

void CupsWriter::Write(const StepResult& result) {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const CupResult& cup = result.cups.at(i);
    *stream_ << result.time << ',' << names_[i] << ',' << static_cast<int>(cup.status) << ','
             << cup.gauge_pressure << ',' << cup.cavity_area << ',' << cup.contact_force << ','
             << cup.num_contacts;
    WriteVector(cup.X_WC.linear() * cup.force_C, stream_);
    WriteVector(cup.X_WC.linear() * cup.torque_C, stream_);
    *stream_ << ',' << cup.bottleneck_gap << ',' << cup.opening.azimuth << ',' << cup.opening.width
             << ',' << cup.opening.largest_gap << ',' << cup.cavity_volume << ',' << cup.leak_flow
             << ',' << cup.leak_area << '\n';
  }
}

}  // namespace vacuum_gripper_sim
