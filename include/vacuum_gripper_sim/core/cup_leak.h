#pragma once

#include "vacuum_gripper_sim/core/lip_leak.h"

namespace vacuum_gripper_sim {

/// All ways by which air comes into a cup from the ambient.
struct CupLeak {
  LeakPaths lip;
  double porosity{0.0};   ///< Permeance of the covered surface times its area. [m^3/(Pa s)]
  double hole_area{0.0};  ///< Effective orifice of holes in cup and surface. [m^2]

  /// @param p_from,p_to Absolute. [Pa] @returns throughput, antisymmetric. [Pa m^3/s]
  double Throughput(double p_from, double p_to) const;
  /// Of the orifice that would let through as much between these pressures. [m^2]
  double EquivalentArea(double p_from, double p_to) const;
};

}  // namespace vacuum_gripper_sim
