#pragma once

#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/lip_leak.h"

namespace vacuum_gripper_sim {

/// What is wrong with one cup.
struct CupFaults {
  double hose_opening{1.0};      ///< Part of the hose's area that a kink leaves, 0 to 1. [-]
  double torn_area{0.0};         ///< Effective orifice of a hole in the cup. [m^2] >= 0
  std::vector<DirtSector> dirt;  ///< Under its lip.
};

/// What is wrong with the vacuum system; nothing by default. Taking a fault back mends it.
struct VacuumFaults {
  bool pump_lost{false};  ///< The supply of compressed air or vacuum, or the pump's drive, is gone.
  bool sensor_stuck{false};        ///< The sensor repeats its last value.
  std::vector<CupFaults> cups;     ///< By cup; those beyond its end have none.
  std::vector<double> permeances;  ///< By object, added to that of its surfaces; likewise.
                                   ///< [m/(Pa s)] >= 0
};

/** Checks every number.
 @param num_cups,num_objects There are so many.
 @throws std::invalid_argument naming the field (`faults.cups[0].torn_area`), its value and what is
   allowed. */
void Validate(const VacuumFaults& faults, std::size_t num_cups, std::size_t num_objects);

}  // namespace vacuum_gripper_sim
