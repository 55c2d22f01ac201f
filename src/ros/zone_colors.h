#pragma once

#include <array>
#include <cstdint>

#include "vacuum_gripper_sim/core/classifier.h"

namespace vacuum_gripper_sim {

/// Red, green and blue, 0 .. 255.
using Rgb = std::array<std::uint8_t, 3>;

/// The colours of [Bernardin, Fig. 3], by zone number.
inline constexpr std::array<Rgb, kNumZones> kZoneColors = {{
    {{250, 210, 30}},  // STRICTLY_OUTSIDE: yellow
    {{150, 50, 190}},  // OUTER_BORDER: purple
    {{225, 40, 35}},   // IN_ACTIVE_CONTACT: red
    {{40, 90, 235}},   // INNER_BORDER: blue
    {{40, 180, 70}},   // STRICTLY_INSIDE: green
}};

inline const Rgb& ColorOf(Zone zone) { return kZoneColors[static_cast<std::size_t>(zone)]; }

}  // namespace vacuum_gripper_sim
