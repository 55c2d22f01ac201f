#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/classifier.h"
#include "vacuum_gripper_sim/core/contact_stage.h"
#include "vacuum_gripper_sim/core/cup_leak.h"
#include "vacuum_gripper_sim/core/gas_network.h"
#include "vacuum_gripper_sim/core/vacuum_source.h"

namespace vacuum_gripper_sim {

/// What a cup's cavity remembers from one step to the next.
struct CavityState {
  bool sealed{false};    ///< Airtight with the regulator at work; of a source that flows: holding.
  bool lost{false};      ///< Held in this grip and no longer does.
  bool reached{false};   ///< Its vacuum is the set-point's.
  bool touches{false};   ///< Objects press on the cup.
  double pressure{0.0};  ///< lambda_p, gauge. [Pa]
};

/// What the air remembers, see GasSuction. One value a cup in each vector.
struct AirMemory {
  GasState gas;
  VacuumSourceState source;
  std::vector<double> volume;      ///< Of the cavities; less than none where one is crushed beyond
                                   ///< what its mesh resolves. [m^3]
  std::vector<double> compliance;  ///< dV/dp of the cups. [m^3/Pa]
  std::vector<double> growth;      ///< Of the volumes in the last step, at constant pressure. [m^3]
  std::vector<bool> swept;         ///< Closed as the last step began: `volume` followed the motion.
  // What the last step found on its way to the pressures.
  std::vector<CupLeak> leaks;
  std::vector<double> slope;  ///< See PressureSearch. [-]
  std::vector<double> miss;   ///< Of the prediction. [Pa]
};

/// What the gripper's cavities remember.
struct GripState {
  std::vector<CavityState> cups;
  Classification classification;  ///< Of the step's end.
  AirMemory air;                  ///< Of a source that flows.
};

/// A solved step: motion, and the cavities at its end.
struct SuctionSolution {
  ContactSolution contact;
  Classification classification;
  Eigen::Matrix3Xd load;  ///< H_p^T lambda_p, 3 by #nodes. [N]
};

}  // namespace vacuum_gripper_sim
