#pragma once

#include <vector>

#include "vacuum_gripper_sim/core/gas_flow.h"

namespace vacuum_gripper_sim {

/// What makes the vacuum.
enum class VacuumSourceType {
  kIdealRegulator,  ///< Imposes the pressure, however much air that takes: core/suction.
  kRegulator,       ///< Holds a set-point with a limited flow.
  kEjector,         ///< Compressed air through a nozzle; on or off.
  kPump,            ///< On or off.
  kPassive,         ///< A closed port.
  kVented           ///< A port open to the ambient.
};

/// A proportional vacuum regulator, fed by a supply of vacuum and open to the ambient on its other
/// side.
struct VacuumRegulatorParameters {
  double time_constant{0.05};  ///< Of the first-order lag of its reference behind the set-point;
                               ///< 0: the rate limit alone. [s] >= 0
  double rate_limit{5e5};      ///< Of the reference. [Pa/s] > 0
  double supply_flow{5e-4};    ///< Most that it draws, as free air. [m^3/s] > 0
};

/// A point of a suction curve as data sheets have it.
struct SuctionPoint {
  double vacuum{0.0};  ///< Gauge. [Pa] <= 0
  double flow{0.0};    ///< As free air. [m^3/s] >= 0
};

/// Flow an ejector or a pump draws over the vacuum it draws from.
struct SuctionCurve {
  double free_flow{2e-4};          ///< At ambient pressure, as free air. [m^3/s] > 0
  double ultimate_vacuum{-85e+3};  ///< Where the flow, falling linearly, ends. [Pa] gauge, < 0 and
                                   ///< above -ambient_pressure
  /// If not empty, the curve instead of the two numbers above, linear between its points: the first
  /// at 0 Pa, each deeper than the one before, with a flow that never rises and ends at 0.
  std::vector<SuctionPoint> table;
};

/// The valve of an ejector or a pump: on (suction), off (port to the ambient), and for a while
/// after switching off, blow-off.
struct VacuumValveParameters {
  double on_delay{0.015};         ///< From command to suction. [s] >= 0
  double off_delay{0.015};        ///< From command to the end of suction. [s] >= 0
  double blow_off_duration{0.1};  ///< Of the pulse of compressed air; 0: none. [s] >= 0
  double blow_off_flow{3e-4};     ///< As free air. [m^3/s] >= 0
  double vent_area{2e-6};         ///< Effective orifice from the port to the ambient, the way
                                  ///< through nozzle and silencer for an ejector. [m^2] > 0
};

/// What joins a cup with the manifold.
struct CupLineParameters {
  double dead_volume{4e-6};  ///< Of hose and fitting, on the cup's side. [m^3] > 0
  double hose_area{4e-6};    ///< Effective orifice of the hose. [m^2] > 0
  /// A pilot-operated check valve at the manifold: while the source is switched on, air passes from
  /// cup to manifold only, so that a cup keeps its vacuum when another one opens or the supply
  /// fails; switching off opens it, or the grip could not be released.
  bool check_valve{false};
};

/** Vacuum system of a gripper. The defaults are of an order typical of small single-stage ejectors
 and diaphragm pumps (5 to 20 l/min of free air, four fifths of a full vacuum, valves that switch
 within tens of milliseconds) with some decimetres of 4 mm hose, as serve one cup of 20 to 40 mm. */
struct VacuumParameters {
  VacuumSourceType source{VacuumSourceType::kIdealRegulator};
  double ambient_pressure{air::kAmbientPressure};  ///< Absolute. [Pa] > 0
  VacuumRegulatorParameters regulator;
  SuctionCurve ejector;
  SuctionCurve pump{1e-4, -75e+3, {}};
  VacuumValveParameters valve;
  double manifold_volume{5e-6};  ///< [m^3] > 0
  CupLineParameters line;        ///< Of every cup.
};

/** Checks every number.
 @throws std::invalid_argument naming the field by its dotted YAML path
   (`vacuum.ejector.free_flow`), its value and what is allowed. */
void Validate(const VacuumParameters& parameters);

/// Flow as free air at a gauge pressure, linear between the curve's points and constant beyond its
/// ends: 0 below the ultimate vacuum. [m^3/s]
double SuctionFlow(const SuctionCurve& curve, double gauge_pressure);

}  // namespace vacuum_gripper_sim
