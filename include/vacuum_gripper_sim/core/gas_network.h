#pragma once

#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

#include "vacuum_gripper_sim/core/vacuum_parameters.h"

namespace vacuum_gripper_sim {

/// What flows from the ambient into a cup at absolute pressures. [Pa m^3/s]
using LeakFlow = std::function<double(double p_from, double p_to)>;

/// What flows into the manifold at its absolute pressure and a time since the step's start [s].
/// [Pa m^3/s]
using SourceFlow = std::function<double(double p_abs, double time)>;

/// The air in the network: its state, see GasNetwork.
struct GasState {
  std::vector<double> amount;   ///< N of each cup with its line. [Pa m^3]
  std::vector<double> volume;   ///< V of each cup with its line. [m^3]
  double manifold_amount{0.0};  ///< [Pa m^3]

  double total_amount() const {
    return std::accumulate(amount.begin(), amount.end(), manifold_amount);
  }
  double pressure(std::size_t k) const { return amount[k] / volume[k]; }  ///< Absolute. [Pa]
};

/// A cup during a step. Its cavity at the step's end has the volume
/// volume + compliance * (p - linear_at), and never less than none.
struct GasCup {
  double volume{0.0};        ///< Without the line's dead volume. [m^3]
  double compliance{0.0};    ///< dV/dp of the mechanics. [m^3/Pa] >= 0
  double linear_at{0.0};     ///< Absolute. [Pa]
  LeakFlow leak;             ///< Never rises with p_to, zero at equal pressures; empty: tight.
  double hose_opening{1.0};  ///< Part of the hose's area that a kink leaves, 0 to 1. [-]
};

/// A solved step. Flows are means over it; pressures absolute and of its end.
struct GasSolution {
  GasState end;                   ///< Committing the step is assigning this to the state.
  std::vector<double> pressure;   ///< Of the cups. [Pa]
  double manifold_pressure{0.0};  ///< [Pa]
  std::vector<double> hose_flow;  ///< Out of the manifold into each cup. [Pa m^3/s]
  std::vector<double> leak_flow;  ///< Out of the ambient into each cup. [Pa m^3/s]
  double source_flow{0.0};        ///< Into the manifold. [Pa m^3/s]
};

/// Of the cups' rows in Newton's method: dp_k = shift_k + slope_k dp_m.
struct EliminatedCups {
  std::vector<double> shift;  ///< [Pa]
  std::vector<double> slope;  ///< [-]
};

/** Air in one manifold and the cups at its hoses, isothermal:

     d(p_k V_k)/dt = Q_hose(p_m, p_k) + Q_leak(p_ambient, p_k)
     d(p_m V_m)/dt = Q_source(p_m) - sum of Q_hose(p_m, p_k)

 by implicit Euler in equal sub-steps of at most kLargestSubStep, over which the cups' volumes go
 linearly to those of the step's end: stable and without overshoot however stiff hoses and leaks
 are, in error by half a sub-step over the time constant (1 % at one time constant of 25 ms), and
 the same for any h to that order. Amounts are moved by the flows, so that none is lost but by
 round-off.

 Every flow falls with the pressure it goes to, hence the equations have one solution. Newton's
 method finds it from the sub-step before: its matrix is an arrow, each cup has the manifold as its
 only neighbour. Should it not converge, nested scalar solves do, since p_k(p_m) is the root of a
 rising function and so is p_m. Working memory is kept: one thread at a time. */
class GasNetwork {
 public:
  static constexpr double kLargestSubStep = 0.5e-3;  ///< [s]
  static constexpr double kTolerance = 1e-7;         ///< Bound on |N / V - p|. [Pa]

  /// @param lines One for each cup. @param manifold_volume [m^3] > 0
  /// @param ambient_pressure Absolute. [Pa]
  GasNetwork(double manifold_volume, std::vector<CupLineParameters> lines, double ambient_pressure);

  std::size_t num_cups() const { return lines_.size(); }

  /// State with all at ambient pressure. @param volumes Of the cavities. [m^3]
  GasState AtAmbient(const std::vector<double>& volumes) const;

  double manifold_pressure(const GasState& state) const {
    return state.manifold_amount / manifold_volume_;
  }

  /** Solves a step and changes nothing but the solution.
   @param start State at the step's start, not that within `solution`.
   @param source Never rises with its pressure and is not negative at 0 Pa.
   @param check_valves_work Whether they close against flow into the cups; false: open.
   @param h [s] @param[out] solution Keeps its storage from call to call.
   @throws std::invalid_argument if the number of cups is not that of the network. */
  void Solve(const GasState& start, const std::vector<GasCup>& cups, const SourceFlow& source,
             bool check_valves_work, double h, GasSolution* solution) const;

 private:
  double manifold_volume_;
  std::vector<CupLineParameters> lines_;
  double ambient_pressure_;
  mutable EliminatedCups eliminated_;
  mutable std::vector<double> pressure_before_;  // of the cups, of the last sub-step [Pa]
};

}  // namespace vacuum_gripper_sim
