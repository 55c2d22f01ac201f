#pragma once

#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

// clang-format off
/** Reads the keys that node and experiment tool share into SimulatorParameters; validates nothing
 but types, Validate(SimulatorParameters) does the rest:

     gravity: [x, y, z]                                    # [m/s^2]
     linear_solver: {method: direct|conjugate_gradient|asynchronous, precision: double|single,
                     tolerance, max_iterations, refactor_interval, threads}
     contact: {solver: active_set|gauss_seidel, tolerance, acceptable_residual, max_iterations,
               relaxation, alarm_distance}
     seal: {close_gap, open_gap, max_rounds, ramp_increments}
     regulator: {default_pressure, min_pressure, ramp_rate}
     cups: [{name, position, orientation}, ...]            # see ReadCupMounts()

 Material, damping and time step come from elsewhere (the cup's file, `rate` or `time_step`) and are
 left at their defaults here. Keys absent keep the defaults of the structs. */
// clang-format on
SimulatorParameters ReadSimulatorParameters(ParameterReader* reader);

}  // namespace vacuum_gripper_sim
