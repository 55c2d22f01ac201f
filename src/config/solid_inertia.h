#pragma once

#include <Eigen/Core>
#include <optional>

#include "vacuum_gripper_sim/core/rigid_surface.h"

namespace vacuum_gripper_sim {

/// Principal moments of a uniform solid of this shape, about its middle and the shape's axes.
/// @param mass [kg] @returns [kg m^2]; nothing for shapes that have no such formula.
std::optional<Eigen::Vector3d> SolidInertia(const Shape& shape, double mass);

}  // namespace vacuum_gripper_sim
