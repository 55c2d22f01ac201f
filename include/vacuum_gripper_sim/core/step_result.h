#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/classifier.h"
#include "vacuum_gripper_sim/core/seal_opening.h"

namespace vacuum_gripper_sim {

/// What the step is asked to reach.
struct Command {
  Eigen::Isometry3d X_WM{Eigen::Isometry3d::Identity()};  ///< Pose of the mount (`cup_frame`) at
                                                          ///< the end of the step, in the world.
  double pressure_setpoint{0.0};  ///< Gauge pressure the regulator aims at. [Pa] <= 0
};

/// State of the grip, numbered as in SealState.msg.
enum class SealStatus : std::uint8_t {
  kOpen = 0,
  kSealed = 1,
  kRegulating = 2,
  kLost = 3,
  kLeaking = 4
};
/// For people: "open", "sealed", "regulating", "lost", "leaking".
const char* NameOf(SealStatus status);
/// Whether the grip lasts: SEALED, REGULATING or LEAKING.
bool Holds(SealStatus status);

/// How a step ended. Failure is data, not an exception: the loop keeps its rate and reports it.
enum class StepOutcome {
  kOk,
  kUnconverged,  ///< A solver missed its tolerance; the step was undone.
  kNonFinite,    ///< The state stopped being finite; the step was undone.
};

/// What a step did to an object.
struct ObjectResult {
  Eigen::Isometry3d X_WO{Eigen::Isometry3d::Identity()};        ///< Its pose.
  Eigen::Vector3d velocity_W{Eigen::Vector3d::Zero()};          ///< Of a free one's origin. [m/s]
  Eigen::Vector3d angular_velocity_W{Eigen::Vector3d::Zero()};  ///< Of a free one. [rad/s]
  Eigen::Vector3d force_W{Eigen::Vector3d::Zero()};   ///< Of the cup on it, pressure included. [N]
  Eigen::Vector3d torque_W{Eigen::Vector3d::Zero()};  ///< About its origin. [N m]
};

/// Wall time of the parts of one step. [s]
struct StepTimings {
  double assembly{0.0};        ///< Internal forces, stiffness, A and b.
  double factorization{0.0};   ///< Of A.
  double free_motion{0.0};     ///< First half of A dv = b, with the load.
  double narrow_phase{0.0};    ///< Distances to the surfaces.
  double classification{0.0};  ///< The classifier.
  double delassus{0.0};        ///< W = h^2 H A^-1 H^T.
  double solve{0.0};           ///< The mixed complementarity problem.
  double air{0.0};             ///< Leaks, volumes and the gas network.
  double correction{0.0};      ///< Second half with the forces, refinement, and the wrench.
  double total{0.0};
};

/// State of the grip of a cup, or of a gripper: the sum of its cups.
struct GripSummary {
  SealStatus status{SealStatus::kOpen};
  double gauge_pressure{0.0};  ///< In the cavity: lambda_p; where air flows that of the air, the
                               ///< same within gas_imbalance; of several cavities the lowest. [Pa]
  double bottleneck_gap{0.0};  ///< Widest gap from port to rim; < 0: loaded ring; +inf: no surface.
                               ///< [m]
  SealOpening opening;  ///< Where the cavity is open to the ambient: of several cavities, the
                        ///< one with the largest gap.
  /// Of the points that the pressure acts on; of an open cup, of those a seal would close off.
  double cavity_area{0.0};        ///< Projected on the suction axis. [m^2]
  double cavity_volume{0.0};      ///< Up to the plane across the edge of those points. [m^3]
  double contact_force{0.0};      ///< Sum of the normal forces of objects on the cup. [N]
  std::uint32_t num_contacts{0};  ///< Contacts of the cup that carry load.
  std::array<std::uint32_t, kNumZones> zone_counts{};
  // Zero with the ideal regulator.
  double leak_flow{0.0};  ///< Into the cavity from the ambient, as free air. [m^3/s]
  double leak_area{0.0};  ///< Of the orifice that would leak as much. [m^2]
};

/// One of the gripper's cups.
struct CupResult : GripSummary {
  Eigen::Isometry3d X_WC{Eigen::Isometry3d::Identity()};  ///< Pose of its mount.
  Eigen::Vector3d force_C{Eigen::Vector3d::Zero()};   ///< Of the cup on its mount, its axes. [N]
  Eigen::Vector3d torque_C{Eigen::Vector3d::Zero()};  ///< About the origin of C, its axes. [N m]
};

/// The gripper's: cups that hold speak for it, one that leaks before one that regulates before one
/// that is sealed; LOST if none holds and one is lost.
GripSummary SumOf(const std::vector<CupResult>& cups);

/// Everything a publisher needs to know of one step; state is that at the step's end.
struct StepResult : GripSummary {
  StepOutcome outcome{StepOutcome::kOk};
  std::string message;  ///< What went wrong; empty if nothing did.
  double time{0.0};     ///< Simulated time since construction. [s]

  Eigen::Isometry3d X_WM{Eigen::Isometry3d::Identity()};  ///< Pose of the mount.
  Eigen::Vector3d force_M{Eigen::Vector3d::Zero()};   ///< Of the cups on the mount, its axes. [N]
  Eigen::Vector3d torque_M{Eigen::Vector3d::Zero()};  ///< About the mount's origin, its axes. [N m]

  double setpoint{0.0};           ///< [Pa]
  double manifold_pressure{0.0};  ///< Gauge; with the ideal regulator that of the cavities. [Pa]
  double source_flow{0.0};        ///< That the vacuum source draws, as free air; negative: it lets
                                  ///< in; zero with the ideal regulator. [m^3/s]
  double gas_imbalance{0.0};      ///< Largest difference of the pressure on a cup and of its air.
                                  ///< [Pa]
  int gas_rounds{0};              ///< Solves of the cups that it took to balance their air.
  double gas_amount{0.0};  ///< Of the air in cups, lines and manifold, p V: a step changes it by
                           ///< h p_ambient (leak_flow - source_flow). [Pa m^3]
  std::vector<CupResult> cups;      ///< In the order of SimulatorParameters::cups.
  double fold_force{0.0};           ///< Sum of the normal forces where cups touch themselves. [N]
  double friction_force{0.0};       ///< Size of the tangential forces' sum. [N]
  std::uint32_t num_candidates{0};  ///< Contact constraints in the problem.
  double max_penetration{0.0};      ///< Over all free surface nodes, >= 0. [m]

  Eigen::Matrix3Xd x_W;           ///< Deformed positions of all mesh nodes, 3 by #nodes. [m]
  Classification classification;  ///< Of the cavity points at the step's end.
  std::vector<double> gap;        ///< Signed distance of each cavity point; +inf: no surface. [m]

  std::vector<ObjectResult> objects;  ///< In the order of Simulator::SetObjects().

  int solver_iterations{0};     ///< Of the last contact solve.
  double solver_residual{0.0};  ///< max_i |min(delta_i, lambda_i W_ii)|. [m]
  int linear_iterations{0};     ///< CG iterations of the step; 0 with the direct solver.
  int factorizations{0};        ///< Of A in this step, on its own thread.
  StepTimings timings;
};

}  // namespace vacuum_gripper_sim
