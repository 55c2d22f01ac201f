#pragma once

#include "vacuum_gripper_sim/config/parameter_reader.h"

namespace vacuum_gripper_sim {

/// What surfaces are like of which a scene says nothing.
struct SurfaceDefaults {
  double friction{0.0};   ///< Coulomb's mu. [-] >= 0
  double roughness{0.0};  ///< h_rms of the heights. [m] >= 0
};

/** Reads the keys `friction` and `roughness`.
 @param defaults Where they are not set.
 @throws std::invalid_argument naming the key, its value and what is allowed. */
SurfaceDefaults ReadSurfaceDefaults(ParameterReader* reader, const SurfaceDefaults& defaults = {});

}  // namespace vacuum_gripper_sim
