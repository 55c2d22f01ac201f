#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "physics/grip_world.h"

namespace vacuum_gripper_sim {

constexpr double kAmbient = air::kAmbientPressure;                      ///< [Pa]
inline const Eigen::Vector3d kAbovePlate{0.0, 0.0, kCupLength + 5e-4};  ///< Mount at the start. [m]

inline SimulatorParameters WithSource(VacuumSourceType source, double h = 0.01) {
  SimulatorParameters parameters = A20(h);
  parameters.vacuum.source = source;
  return parameters;
}

/// The plane z = 0.
inline RigidObject Plate(double roughness = 0.0, double friction = 0.0) {
  RigidSurface plate{"plate", Plane{}};
  plate.roughness = roughness;
  plate.friction = friction;
  return FixedObject(plate);
}

/// Of the mount when the lip, undeformed, is so far above the plate. [m]
inline Eigen::Vector3d Lifted(double height) { return {0.0, 0.0, kCupLength + height}; }

/// Looks at what the air does in every step of a world.
class AirWatch {
 public:
  /// Must not outlive `world`, nor that move while this lives.
  explicit AirWatch(GripWorld* world)
      : h_(world->simulator().parameters().time_step), expected_(world->result().gas_amount) {
    statuses.push_back(world->result().status);
    world->after_step = [this](const StepResult& result) { Look(result); };
  }

  std::vector<SealStatus> statuses;  ///< One after the other, without repeats.
  double largest_mass_error{0.0};    ///< Of the amount of air against the flows' sum. [-]
  double largest_amount{0.0};        ///< [Pa m^3]
  int unbalanced_steps{0};           ///< That ended further from balance than its tolerance.
  double largest_imbalance{0.0};     ///< [Pa]
  double deepest_pressure{0.0};      ///< Gauge. [Pa]
  double peak_force{0.0};            ///< Along the suction axis, pulling on the mount. [N]
  int rounds{0}, steps{0};

 private:
  void Look(const StepResult& result) {
    if (result.outcome != StepOutcome::kOk) return;
    ++steps;
    rounds += result.gas_rounds;
    if (result.status != statuses.back()) statuses.push_back(result.status);
    expected_ += h_ * kAmbient * (result.leak_flow - result.source_flow);
    largest_amount = std::max(largest_amount, result.gas_amount);
    largest_mass_error =
        std::max(largest_mass_error, std::abs(result.gas_amount - expected_) / largest_amount);
    // Twice what GasSuction aims at.
    unbalanced_steps += result.gas_imbalance > 2.0 + 1e-3 * std::abs(result.gauge_pressure);
    largest_imbalance = std::max(largest_imbalance, result.gas_imbalance);
    deepest_pressure = std::min(deepest_pressure, result.gauge_pressure);
    peak_force = std::max(peak_force, result.force_M.z());
  }

  double h_;         // s
  double expected_;  // amount of air by the flows [Pa m^3]
};

/// Root of a falling function between two values.
inline double FallingRoot(const std::function<double(double)>& f, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace vacuum_gripper_sim
