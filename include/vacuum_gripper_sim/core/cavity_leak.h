#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/cup_array.h"
#include "vacuum_gripper_sim/core/cup_leak.h"
#include "vacuum_gripper_sim/core/grip_state.h"
#include "vacuum_gripper_sim/core/lip_leak.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/vacuum_faults.h"

namespace vacuum_gripper_sim {

/** Measures the leaks of a gripper's cups on what they touch: below the lip (LipLeak), through a
 porous surface that the cavity covers,

     Q = kappa A (p_from^2 - p_to^2) / 2,

 isothermal flow by Darcy's law with the permeance kappa = k / (mu L) of a wall of thickness L, and
 through holes in the surface or in the cup. A hole counts while the nearest point of the cavity
 surface sees the cavity's pressure and is no further away than the rim's radius. */
class CavityLeak {
 public:
  /// @param cups Must outlive this. @param open_gap See SealParameters. [m]
  /// @param reduced_modulus E* of the cup, see LipLeak. [Pa]
  /// @throws std::invalid_argument, see LipLeak.
  CavityLeak(const CupArray& cups, double open_gap, double reduced_modulus);

  /** @param stage At the end of the solution. @param world That it moves in. @param solution End of
   a step. @param wet By point: sees its cup's pressure. @param area_vectors Of the points. [m^2]
   @param[out] leaks One a cup. */
  void Measure(const ContactStage& stage, const RigidWorld& world, const SuctionSolution& solution,
               const std::vector<bool>& wet, const Eigen::Matrix3Xd& area_vectors,
               const VacuumFaults& faults, std::vector<CupLeak>* leaks);

 private:
  double HoleArea(int cup, const RigidWorld& world, const Eigen::Matrix3Xd& x_W,
                  const std::vector<bool>& wet) const;

  const CupArray* cups_;
  LipLeak lip_;
  Eigen::Matrix3Xd x_W_;  // of one cup [m]
  LipContact contact_;    // of one cup
};

}  // namespace vacuum_gripper_sim
