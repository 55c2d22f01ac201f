#pragma once

#include <ros/time.h>

#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_object.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/// What is published of an object beside its result.
struct ObjectLabel {
  std::string name;  // of its link, also its frame
  bool is_free{false};
};

/// Why a moment is published.
enum class Occasion {
  kStep,
  kReset,  ///< The state began anew, no step was made: only what is latched is published.
};

/// Everything that is published of one moment of the simulation; a copy, to be read while the
/// simulation goes on.
struct Moment {
  Occasion occasion{Occasion::kStep};
  ros::Time stamp;
  StepResult result;
  std::vector<ObjectLabel> objects;  ///< Of the result.
  bool sensor_stuck{false};          ///< Fault of the vacuum sensor.
};

/// Into memory that is there already.
void SetLabels(const std::vector<RigidObject>& objects, std::vector<ObjectLabel>* labels);

}  // namespace vacuum_gripper_sim
