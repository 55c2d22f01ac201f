#pragma once

#include <ostream>

#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/** Writes one CSV row a step. Force and torque in world axes about the mount's origin, pressure
 gauge, status as the number of SealStatus; the header line names the columns. */
class TimeseriesWriter {
 public:
  /// Writes the header line. @param stream Must outlive the writer; gets the C locale.
  explicit TimeseriesWriter(std::ostream* stream);

  void Write(const StepResult& result);

 private:
  std::ostream* stream_;
};

}  // namespace vacuum_gripper_sim
