#pragma once

#include "vacuum_gripper_sim/core/material_model.h"
#include "vacuum_gripper_sim/core/pack.h"

namespace vacuum_gripper_sim {

// What material_model says of one F, of some side by side.

/// How many packs hold what a law keeps of its tangent at a point.
constexpr int TangentSize(const CorotationalLaw&) { return 9; }  // the rotation
constexpr int TangentSize(const NeoHookeanLaw&) { return 81; }

/// P at F. [Pa] @param[out] tangent TangentSize() packs.
PackMatrix3 Stress(const CorotationalLaw& law, const PackMatrix3& F, Pack* tangent);
PackMatrix3 Stress(const NeoHookeanLaw& law, const PackMatrix3& F, Pack* tangent);

/// dP of a dF. [Pa]
PackMatrix3 StressChange(const CorotationalLaw& law, const Pack* tangent, const PackMatrix3& dF);
PackMatrix3 StressChange(const NeoHookeanLaw& law, const Pack* tangent, const PackMatrix3& dF);

/// The tangent in one lane.
CorotationalLaw::Tangent TangentAt(const CorotationalLaw& law, const Pack* tangent, int lane);
NeoHookeanLaw::Tangent TangentAt(const NeoHookeanLaw& law, const Pack* tangent, int lane);

}  // namespace vacuum_gripper_sim
