#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/** Writes one CSV row for every cup and step: what the time series has in sum, with the force [N]
 and torque [N m] of the cup on its mount about that mount's origin, in world axes; azimuths [rad]
 are about the cup's own axis; the header line names the columns. */
class CupsWriter {
 public:
  /// Writes the header line. @param stream Must outlive the writer; gets the C locale.
  CupsWriter(const std::vector<CupMount>& cups, std::ostream* stream);

  void Write(const StepResult& result);

 private:
  std::vector<std::string> names_;
  std::ostream* stream_;
};

}  // namespace vacuum_gripper_sim
