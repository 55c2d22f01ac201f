#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <utility>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_leak.h"
#include "vacuum_gripper_sim/core/cavity_stage.h"
#include "vacuum_gripper_sim/core/contact_stage.h"
#include "vacuum_gripper_sim/core/cup_array.h"
#include "vacuum_gripper_sim/core/gas_network.h"
#include "vacuum_gripper_sim/core/grip_state.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/pressure_search.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/vacuum_faults.h"
#include "vacuum_gripper_sim/core/vacuum_source.h"

namespace vacuum_gripper_sim {

/// What the air did in a step. Flows are as free air, [m^3/s].
struct AirFlows {
  double manifold_pressure{0.0};   ///< Gauge. [Pa]
  double source_flow{0.0};         ///< That the source drew; negative: it let in.
  std::vector<double> pressure;    ///< Of the air in each cup, gauge: N / V. [Pa]
  std::vector<double> leak_flow;   ///< Into each cup.
  std::vector<double> leak_area;   ///< Of the orifice that would leak as much. [m^2]
  std::vector<SealStatus> status;  ///< Of each cup.
  double imbalance{0.0};           ///< Of pressures that load the cups and those of their air. [Pa]
  int rounds{0};                   ///< Solves of the cups that the balance took.
};

/** Couples cups and air: the pressure of each cavity is an unknown of the step, and lambda_p in

     delta = delta_free + W_cc lambda_c + W_cp lambda_p,   0 <= delta  perp  lambda_c >= 0,
     (p_ambient + lambda_p) (V(x) + V_dead) = N + h (Q_hose + Q_leak(x, lambda_p)),

 the second row being that of GasNetwork at the step's end. For given pressures the first row is a
 contact problem; its end says how large the cavities are and how far they are open, from which the
 network finds the pressures. PressureSearch closes the circle, for each cup along its own
 compliance dV/dp, which it learns on the way and remembers: mostly one or two solves a step.

 The volume of a cavity follows the motion of the points that see its pressure (SweptVolume), from
 the air under the cup where it first touches (AirVolume). Amounts of air are moved by flows only,
 so that none is lost or made, whatever the search leaves over.

 A cup holds once it was airtight with a part of the set-point's vacuum, until less than that is
 left; then the grip is lost. While it holds it is SEALED if its vacuum is the set-point's,
 REGULATING if the source can get it there against all leaks at hand, LEAKING if not. A passive cup
 has no set-point: SEALED while airtight, LEAKING while it is not. */
class GasSuction {
 public:
  /** @param cups Must outlive this. @param parameters Validated, with the seal's gaps set and a
     source that flows.
   @throws std::invalid_argument, see LipLeak. */
  GasSuction(const CupArray& cups, const SimulatorParameters& parameters);
  // Neither moved nor copied: the network asks this for the leaks.
  GasSuction(const GasSuction&) = delete;
  GasSuction& operator=(const GasSuction&) = delete;
  ~GasSuction() = default;

  /// Ambient pressure everywhere, the cups at rest. @param x_W 3 by #nodes. [m]
  AirMemory AtRest(const Eigen::Matrix3Xd& x_W, const std::vector<bool>& wet) const;

  void SetFaults(VacuumFaults faults) { faults_ = std::move(faults); }
  const VacuumFaults& faults() const { return faults_; }

  /** Solves the step's contacts and pressures, see Suction::Solve().
   @param X_WM Pose of the mount at its end. @param world That the stage began with. */
  bool Solve(const Eigen::Matrix3Xd& x_W, const Eigen::Isometry3d& X_WM, const RigidWorld& world,
             double setpoint, double h, ContactStage* stage, GripState* state,
             SuctionSolution* solution, StepTimings* timings);

  const AirFlows& flows() const { return flows_; }

 private:
  void Predict(const AirMemory& air, double h);
  bool IsClosed(std::size_t cup, const GripState& state) const;
  double OpenVolume(std::size_t cup, const Eigen::Matrix3Xd& x_W, const Eigen::Matrix3Xd& areas,
                    const ContactStage& stage, const Classification& classification) const;
  void MeasureOpenCups(const Eigen::Matrix3Xd& x_W, const ContactStage& stage, GripState* state);
  void MeasureVolumes(const Eigen::Matrix3Xd& x_W, const RigidWorld& world, double h,
                      const ContactStage& stage, const GripState& state,
                      const ContactSolution& contact);
  void SolveNetwork(const AirMemory& air, double h);
  double Imbalance() const;
  SealStatus StatusOf(std::size_t cup, double setpoint, bool can_hold,
                      const SuctionSolution& solution, CavityState* cavity) const;
  void Report(double setpoint, double h, const SuctionSolution& solution, GripState* state);

  const CupArray* cups_;
  VacuumParameters vacuum_;
  double open_gap_;
  CavityStage cavity_;
  CavityLeak cavity_leak_;
  GasNetwork network_;
  VacuumSource source_;
  VacuumFaults faults_;

  // Of the step at hand, by cup.
  Eigen::Isometry3d X_WM_{Eigen::Isometry3d::Identity()};
  std::vector<double> exchanged_;  // with the ambient, at the mouths of open cups [Pa m^3]
  std::vector<double> pressure_;   // gauge, that the cups are loaded with [Pa]
  std::vector<double> volume_;     // at its end under that [m^3]
  std::vector<double> tried_pressure_, tried_volume_;  // of the solve before
  std::vector<double> compliance_;                     // m^3/Pa
  std::vector<double> unaided_;                        // predictions by the network alone [Pa]
  std::vector<PressureSearch> searches_;
  std::vector<CupLeak> leaks_;
  std::vector<GasCup> gas_cups_;
  GasSolution gas_;
  Eigen::Matrix3Xd areas_end_;  // m^2
  Eigen::Matrix3Xd motion_W_;   // of the points with respect to the objects [m]
  AirFlows flows_;
};

}  // namespace vacuum_gripper_sim
