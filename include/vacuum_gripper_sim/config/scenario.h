#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/config/cup_file.h"
#include "vacuum_gripper_sim/config/fault_list.h"
#include "vacuum_gripper_sim/config/surface_list.h"
#include "vacuum_gripper_sim/config/timeline.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/rigid_object.h"
#include "vacuum_gripper_sim/core/vacuum_sensor.h"

namespace vacuum_gripper_sim {

/// An experiment: a cup, what it touches, what its mount does and what breaks.
struct Scenario {
  std::string name;
  Cup cup;
  SimulatorParameters parameters;         ///< Time step, material and damping included; validated.
  VacuumSensorParameters sensor;          ///< Validated.
  std::vector<RigidObject> objects;       ///< The world.
  std::vector<ObjectMotion> motions;      ///< Of those that somebody moves.
  bool object_output{false};              ///< Write the objects' motion even if none moves.
  double duration{0.0};                   ///< [s] > 0
  std::optional<double> stop_after_loss;  ///< The run ends this long after the loss. [s] >= 0
  std::vector<Keyframe> timeline;         ///< Of the mount, in the world.
  std::vector<FaultEvent> faults;         ///< In the order of their times; all of them possible.

  /// Steps of size h that cover the duration.
  int num_steps() const;
  bool HasMovingObjects() const;  ///< Free ones, or such that somebody moves.
  /// Those that are on at a time.
  FaultList FaultsAt(double time) const;
};

/// The scenario's file: `name` itself if it is a path or a file, else `name`.yaml among the
/// experiments that ship below `share_directory`. @throws std::invalid_argument if there is none.
std::string FindScenario(const std::string& name, const std::string& share_directory);

/** Reads a scenario. Its keys are explained in config/experiments/template.yaml: `name`,
 `description`, `cup`, `surfaces` or `scene`, `friction`, `roughness`, `object_output`, `time_step`,
 `duration`, `stop_after_loss`, `timeline`, `faults` and those of ReadSimulatorParameters() and
 ReadVacuumSystem(). Without surfaces and scene
 there is a plane at z = 0.

 @param path            The YAML file. Relative paths in it (cup, mesh, scene) are relative to it.
 @param overrides       `key.path=value` each, applied in order; see ApplyOverride(). A key below a
                        cup given by name or file (`cup.young_modulus`) changes that cup.
 @param share_directory Where `config/cups` is; see ShareDirectory().
 @throws std::invalid_argument with one line that names the file or key, its value and what is
   allowed. */
Scenario ReadScenario(const std::string& path, const std::vector<std::string>& overrides,
                      const std::string& share_directory);

}  // namespace vacuum_gripper_sim
