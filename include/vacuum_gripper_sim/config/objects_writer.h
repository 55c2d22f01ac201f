#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_object.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/** Writes one CSV row for every object and step: time, name, position [m] and quaternion of its
 frame, velocity [m/s], and force [N] and torque [N m] of the cup on it about its frame's origin,
 all in world axes; the header line names the columns. */
class ObjectsWriter {
 public:
  /// Writes the header line. @param stream Must outlive the writer; gets the C locale.
  ObjectsWriter(const std::vector<RigidObject>& objects, std::ostream* stream);

  void Write(const StepResult& result);

 private:
  std::vector<std::string> names_;
  std::ostream* stream_;
};

}  // namespace vacuum_gripper_sim
