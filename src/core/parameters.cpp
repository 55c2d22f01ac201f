#include "vacuum_gripper_sim/core/parameters.h"

#include <cmath>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>

#include "require.h"
#include "vacuum_gripper_sim/core/rigid_surface.h"

namespace vacuum_gripper_sim {
namespace {

void RequireCups(const std::vector<CupMount>& cups) {
  if (cups.empty()) throw std::invalid_argument("cups has 0 entries, must have at least one");
  std::set<std::string> names;
  for (std::size_t i = 0; i < cups.size(); ++i) {
    const std::string field = "cups[" + std::to_string(i) + "]";
    if (!IsRigidMotion(cups[i].X_MC)) {
      throw std::invalid_argument(field + ".X_MC is not a finite rigid motion, must be one");
    }
    if (cups.size() == 1) continue;
    if (cups[i].name.empty() || !names.insert(cups[i].name).second) {
      throw std::invalid_argument(field + ".name = '" + cups[i].name +
                                  "', must be not empty and no other cup's");
    }
  }
}

}  // namespace

void Validate(const SimulatorParameters& p) {
  Require(p.time_step > 0.0 && p.time_step <= 0.1, "time_step", p.time_step, "in (0, 0.1] [s]");
  RequireCups(p.cups);
  for (int i = 0; i < 3; ++i) {
    Require(std::isfinite(p.gravity(i)), "gravity", p.gravity(i), "finite [m/s^2]");
  }

  RequirePositive("cup.young_modulus", p.material.young_modulus, "[Pa]");
  Require(p.material.poisson_ratio >= 0.0 && p.material.poisson_ratio < 0.5, "cup.poisson_ratio",
          p.material.poisson_ratio, "in [0, 0.5) [-]");
  RequirePositive("cup.density", p.material.density, "[kg/m^3]");
  RequireNotNegative("cup.damping.mass", p.damping.mass, "[1/s]");
  RequireNotNegative("cup.damping.stiffness", p.damping.stiffness, "[s]");

  Require(p.linear_solver.tolerance > 0.0 && p.linear_solver.tolerance < 1.0,
          "linear_solver.tolerance", p.linear_solver.tolerance, "in (0, 1) [-]");
  Require(p.linear_solver.position_tolerance >= 0.0 && p.linear_solver.position_tolerance <= 1e-5,
          "linear_solver.position_tolerance", p.linear_solver.position_tolerance,
          "in [0, 1e-5] [m]");
  RequireAtLeastOne("linear_solver.max_iterations", p.linear_solver.max_iterations);
  RequireAtLeastOne("linear_solver.refactor_interval", p.linear_solver.refactor_interval);
  Require(p.linear_solver.threads >= 1 && p.linear_solver.threads <= 16, "linear_solver.threads",
          p.linear_solver.threads, "from 1 to 16");

  RequirePositive("contact.tolerance", p.contact.tolerance, "[m]");
  Require(std::isfinite(p.contact.acceptable_residual) &&
              p.contact.acceptable_residual >= p.contact.tolerance,
          "contact.acceptable_residual", p.contact.acceptable_residual,
          "finite and >= contact.tolerance [m]");
  RequireAtLeastOne("contact.max_iterations", p.contact.max_iterations);
  Require(p.contact.relaxation > 0.0 && p.contact.relaxation < 2.0, "contact.relaxation",
          p.contact.relaxation, "in (0, 2) [-]");
  RequirePositive("contact.alarm_distance", p.contact.alarm_distance, "[m]");

  if (p.seal.close_gap) RequirePositive("seal.close_gap", *p.seal.close_gap, "[m]");
  if (p.seal.open_gap) {
    const double gap = *p.seal.open_gap;
    Require(std::isfinite(gap) && gap > 0.0 && gap >= p.seal.close_gap.value_or(0.0),
            "seal.open_gap", gap, "finite, > 0 and >= seal.close_gap [m]");
  }
  RequireAtLeastOne("seal.max_rounds", p.seal.max_rounds);
  RequireAtLeastOne("seal.ramp_increments", p.seal.ramp_increments);

  Require(std::isfinite(p.regulator.min_pressure) && p.regulator.min_pressure < 0.0,
          "regulator.min_pressure", p.regulator.min_pressure, "finite and < 0 [Pa]");
  Require(p.regulator.default_pressure <= 0.0 &&
              p.regulator.default_pressure >= p.regulator.min_pressure,
          "regulator.default_pressure", p.regulator.default_pressure,
          "in [regulator.min_pressure, 0] [Pa]");
  RequirePositive("regulator.ramp_rate", p.regulator.ramp_rate, "[Pa/s]");
  Validate(p.vacuum);
}

}  // namespace vacuum_gripper_sim
