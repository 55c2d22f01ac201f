#pragma once

#include <ostream>

#include "vacuum_gripper_sim/core/cup_array.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/** Writes deformed cups as an unstructured grid of VTK (XML, ASCII): linear or quadratic
 tetrahedra, points in the world [m], and at each point

 - `displacement` [m] from the rest shape carried rigidly by the mount,
 - `zone`, the number of the Zone, -1 off the cavity surface,
 - `gap` [m] to the nearest surface, kNoGap off the cavity surface and where there is none (VTK's
   ASCII reader stops at what is not finite).

 @param result Its x_W, X_WM, gap and zones are written; gap and zones may be empty.
 @throws std::invalid_argument if the sizes disagree. */
void WriteVtu(const CupArray& cups, const StepResult& result, std::ostream* stream);

inline constexpr double kNoGap = 1000.0;  ///< Stands for "no surface" in `gap`. [m]

}  // namespace vacuum_gripper_sim
