#pragma once

#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "vacuum_gripper_sim/core/vacuum_parameters.h"
#include "vacuum_gripper_sim/core/vacuum_sensor.h"

namespace vacuum_gripper_sim {

/// A gripper's source of vacuum, its hoses, and the sensor on its manifold.
struct VacuumSystem {
  VacuumParameters parameters;
  VacuumSensorParameters sensor;
};

// clang-format off
/** Reads the keys that node and experiment tool share:

     ambient_pressure                                               # [Pa] absolute
     vacuum:
       source: ideal_regulator|regulator|ejector|pump|passive|vented
       regulator: {time_constant, rate_limit, supply_flow}
       ejector: {free_flow, ultimate_vacuum, table: [[vacuum, flow], ...]}
       pump: (likewise)
       valve: {on_delay, off_delay, blow_off_duration, blow_off_flow, vent_area}
       manifold_volume
       line: {dead_volume, hose_area, check_valve}
       sensor: {rate, delay, pressure_noise, flow_noise, pressure_resolution, range_min, range_max,
                seed, part_present_level, part_detached_level, hysteresis, hold_time}

 Keys absent keep the defaults of the structs.
 @throws std::invalid_argument naming the key, its value and what is allowed. */
// clang-format on
VacuumSystem ReadVacuumSystem(ParameterReader* reader);

}  // namespace vacuum_gripper_sim
