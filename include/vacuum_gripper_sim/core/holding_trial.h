#pragma once

#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/simulator.h"
#include "vacuum_gripper_sim/core/snapshot.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// How much more a grip would bear before it fails, see HoldingTrial. Zero where nothing is held.
struct HoldingReserve {
  double time{0.0};            ///< Of the moment it holds for. [s]
  bool holds{false};           ///< Does the gripper hold something then?
  double normal_force{0.0};    ///< More pull along the suction axis. [N] >= 0
  double shear_force{0.0};     ///< More force across it. [N] >= 0
  double tilting_moment{0.0};  ///< More moment across it, about the middle of the rims. [N m] >= 0
};

/** Finds what a grip would bear by trying it on a copy: from a moment of a simulation on, with all
 objects clamped where they are and the set-point kept, the mount is moved against them until the
 grip fails, three times:

 - pulled back along the suction axis,
 - pushed across it in the direction of the shear that it carries (of the mount's x axis if none),
 - turned about the middle of the cups' rims in the direction of the moment that it carries there
   about an axis across (about the mount's x axis if none).

 The margin is the largest force or moment in that direction on the way, less the present one. All
 that the simulation knows takes part: curved surfaces, leaks, the pump, friction, tilt, buckling
 walls. A grip that slides keeps what friction gives it. The rim moves at kSpeed, so that pumps act
 within that time as they would. */
class HoldingTrial {
 public:
  static constexpr double kSpeed = 0.02;  ///< Of mount or rim. [m/s]

  /// @param mesh,parameters Those of the simulator that is to be copied.
  HoldingTrial(const TetMesh& mesh, const SimulatorParameters& parameters);

  HoldingReserve Measure(const Snapshot& moment);

 private:
  struct Motion;
  double Bear(const Snapshot& moment, const Motion& motion);

  Simulator simulator_;
};

}  // namespace vacuum_gripper_sim
