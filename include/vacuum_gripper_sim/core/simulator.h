#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <thread>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/cup_array.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/rigid_object.h"
#include "vacuum_gripper_sim/core/snapshot.h"
#include "vacuum_gripper_sim/core/step_result.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"
#include "vacuum_gripper_sim/core/vacuum_faults.h"

namespace vacuum_gripper_sim {

/** A gripper of one or more suction cups among rigid objects, advanced step by step as in
 [Bernardin, Sec. III-A].

 The mount frame M (`cup_frame`) is that of MountFromRest(). Cups that are several share it, each at
 its own place.

 [Bernardin] A. Bernardin, C. Duriez, M. Marchal, "An Interactive Physically-based Model for Active
   Suction Phenomenon Simulation", IROS 2019. */
class Simulator {
 public:
  /** @param mesh       A single cup at rest.
      @param parameters Checked here.
      @param X_WM       Initial pose of the mount.
      @throws std::invalid_argument if a parameter or the mesh's cavity is unusable. */
  Simulator(const TetMesh& mesh, const SimulatorParameters& parameters,
            const Eigen::Isometry3d& X_WM = Eigen::Isometry3d::Identity());
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// Replaces the world; free objects start with their velocities.
  /// @throws std::invalid_argument, see Validate(const RigidObject&).
  void SetObjects(std::vector<RigidObject> objects);
  /// Where they are now.
  const std::vector<RigidObject>& objects() const;

  /// Moves object `index` for the steps to come; a free one comes to rest there.
  /// @throws std::invalid_argument if the pose is not finite, std::out_of_range for an unknown
  /// index.
  void SetObjectPose(int index, const Eigen::Isometry3d& X_WO);

  /// What is wrong from the next step on, all of it; the ideal regulator knows no faults.
  /// @throws std::invalid_argument, see Validate(const VacuumFaults&).
  void SetFaults(const VacuumFaults& faults);

  /** Advances the cup by one time step h.

   A step that ends unconverged or non-finite is undone: the result then shows the last good state
   with the reason in `outcome` and `message`, and the next step starts from that state.
   One that cannot go well is not tried: an object was put more than 5 mm into the cup in one step,
   or a free one as much into another; the message names them, until they are put elsewhere.

   @pre command.X_WM is a rigid motion, command.pressure_setpoint in [min_pressure, 0]; a command
     that is not is refused as kNonFinite, nothing moves.
   @returns the result, valid until the next call of a non-const member. */
  const StepResult& Step(const Command& command);

  /// Rest shape at a pose, at rest, vented. Simulated time goes on; objects stay where they are.
  void Reset(const Eigen::Isometry3d& X_WM);

  /// Threads that a step waits for once they have begun to help it (`linear_solver.threads`), for
  /// setting how they are scheduled. Valid as long as this is.
  std::vector<std::thread::native_handle_type> HelperThreads();

  /// The moment after the last step.
  Snapshot Save() const;
  /** Takes up a moment of this or another simulator of the same cups: motion, air and objects are
   those of the snapshot, contact forces are found anew. result() is its state at rest until the
   next step. @throws std::invalid_argument if it is of other cups, or as SetObjects(), SetFaults().
 */
  void Restore(const Snapshot& snapshot);

  const StepResult& result() const;  ///< Of the last step, or the state at start.
  const CupArray& cups() const;
  const TetMesh& mesh() const;                    ///< Of all cups.
  const CavitySurface& cavity() const;            ///< Likewise.
  const SimulatorParameters& parameters() const;  ///< With the seal's gaps set.

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace vacuum_gripper_sim
