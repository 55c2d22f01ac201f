#pragma once

#include <yaml-cpp/yaml.h>

#include <map>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "vacuum_gripper_sim/core/rigid_object.h"
#include "vacuum_gripper_sim/core/vacuum_faults.h"

namespace vacuum_gripper_sim {

/// What to break or to mend, in the words of SetFault.srv.
struct FaultCommand {
  std::string fault;    ///< pump_lost, hose_kinked, cup_torn, dirty_lip, porous_object or
                        ///< sensor_stuck.
  bool active{true};    ///< False: it is mended, the numbers below do not matter.
  std::string target;   ///< Name of the cup or the object; empty: the only one.
  double value{0.0};    ///< hose_kinked: part of the hose's area that is left [-]; cup_torn:
                        ///< effective orifice of the hole [m^2]; dirty_lip: gap under the lip [m];
                        ///< porous_object: permeance [m/(Pa s)].
  double azimuth{0.0};  ///< dirty_lip: of the sector's middle, about z of the cup from x. [rad]
  double width{0.0};    ///< dirty_lip: of the sector. [rad]
};

/// One that comes at its time.
struct FaultEvent {
  double time{0.0};  ///< [s] >= 0
  FaultCommand command;
};

/// Reads `{fault, active, target, value, azimuth, width}`, all but `fault` optional.
FaultCommand ReadFaultCommand(ParameterReader* reader);

/** Reads a list of faults from the start on. @param name Dotted path of the list, for messages.
 @throws std::invalid_argument naming the key, its value and what is allowed. */
std::vector<FaultCommand> ReadFaults(const YAML::Node& node, const std::string& name);

/// The same with a `time` each, by default zero, which must not fall.
std::vector<FaultEvent> ReadFaultEvents(const YAML::Node& node, const std::string& name);

/** The faults that are on, by the names of cups and objects. One of each kind a cup or object, but
 dirt at any number of azimuths. */
class FaultList {
 public:
  /** @param cups    Names; that of a single cup may be empty.
      @param objects Names of all that there may ever be.
      @param air_flows False with the ideal regulator, whose pressure no fault changes. */
  FaultList(std::vector<std::string> cups, std::vector<std::string> objects, bool air_flows);

  /** Breaks or mends.
   @returns what it did, in a sentence.
   @throws std::invalid_argument naming the field, its value and what is allowed: an unknown fault
     or target, a target where there is nothing to choose, a bad number, or a fault that does
     nothing with this source. Nothing changes then. */
  std::string Apply(const FaultCommand& command);

  /// For the simulator. @param objects Its own.
  VacuumFaults ToFaults(const std::vector<RigidObject>& objects) const;

  bool sensor_stuck() const { return faults_.sensor_stuck; }

 private:
  std::string ApplyToCup(const FaultCommand& command);
  std::string ApplyToObject(const FaultCommand& command);

  std::vector<std::string> cups_;
  std::vector<std::string> objects_;
  bool air_flows_;
  VacuumFaults faults_;                       // without permeances
  std::map<std::string, double> permeances_;  // by object [m/(Pa s)]
};

}  // namespace vacuum_gripper_sim
