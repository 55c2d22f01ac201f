#include "vacuum_gripper_sim/core/vacuum_parameters.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "require.h"

namespace vacuum_gripper_sim {
namespace {

void ValidateCurve(const SuctionCurve& curve, const std::string& path, double ambient_pressure) {
  RequirePositive((path + ".free_flow").c_str(), curve.free_flow, "[m^3/s]");
  Require(curve.ultimate_vacuum < 0.0 && curve.ultimate_vacuum > -ambient_pressure,
          (path + ".ultimate_vacuum").c_str(), curve.ultimate_vacuum,
          "in (-vacuum.ambient_pressure, 0) [Pa]");
  if (curve.table.empty()) return;

  const std::string vacuum_name = path + ".table.vacuum";
  const std::string flow_name = path + ".table.flow";
  const auto& first = curve.table.front();
  Require(first.vacuum == 0.0, vacuum_name.c_str(), first.vacuum, "0 [Pa] in the first point");
  RequirePositive(flow_name.c_str(), first.flow, "[m^3/s] in the first point");
  for (std::size_t i = 1; i < curve.table.size(); ++i) {
    const SuctionPoint& before = curve.table[i - 1];
    const SuctionPoint& point = curve.table[i];
    Require(point.vacuum < before.vacuum && point.vacuum > -ambient_pressure, vacuum_name.c_str(),
            point.vacuum, "deeper than the point before and above -vacuum.ambient_pressure [Pa]");
    Require(point.flow >= 0.0 && point.flow <= before.flow, flow_name.c_str(), point.flow,
            ">= 0 and at most that of the point before [m^3/s]");
  }
  Require(curve.table.back().flow == 0.0, flow_name.c_str(), curve.table.back().flow,
          "0 [m^3/s] in the last point");
}

}  // namespace

void Validate(const VacuumParameters& p) {
  Require(p.source >= VacuumSourceType::kIdealRegulator && p.source <= VacuumSourceType::kVented,
          "vacuum.source", static_cast<double>(p.source),
          "ideal_regulator (0), regulator, ejector, pump, passive or vented (5)");
  RequirePositive("vacuum.ambient_pressure", p.ambient_pressure, "[Pa]");

  RequireNotNegative("vacuum.regulator.time_constant", p.regulator.time_constant, "[s]");
  RequirePositive("vacuum.regulator.rate_limit", p.regulator.rate_limit, "[Pa/s]");
  RequirePositive("vacuum.regulator.supply_flow", p.regulator.supply_flow, "[m^3/s]");

  ValidateCurve(p.ejector, "vacuum.ejector", p.ambient_pressure);
  ValidateCurve(p.pump, "vacuum.pump", p.ambient_pressure);

  RequireNotNegative("vacuum.valve.on_delay", p.valve.on_delay, "[s]");
  RequireNotNegative("vacuum.valve.off_delay", p.valve.off_delay, "[s]");
  RequireNotNegative("vacuum.valve.blow_off_duration", p.valve.blow_off_duration, "[s]");
  RequireNotNegative("vacuum.valve.blow_off_flow", p.valve.blow_off_flow, "[m^3/s]");
  RequirePositive("vacuum.valve.vent_area", p.valve.vent_area, "[m^2]");

  RequirePositive("vacuum.manifold_volume", p.manifold_volume, "[m^3]");
  RequirePositive("vacuum.line.dead_volume", p.line.dead_volume, "[m^3]");
  RequirePositive("vacuum.line.hose_area", p.line.hose_area, "[m^2]");
}

double SuctionFlow(const SuctionCurve& curve, double gauge_pressure) {
  if (curve.table.empty()) {
    return curve.free_flow * std::clamp(1.0 - gauge_pressure / curve.ultimate_vacuum, 0.0, 1.0);
  }
  const auto& table = curve.table;
  if (gauge_pressure >= table.front().vacuum) return table.front().flow;
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (gauge_pressure < table[i].vacuum) continue;
    const double s =
        (gauge_pressure - table[i - 1].vacuum) / (table[i].vacuum - table[i - 1].vacuum);
    return (1.0 - s) * table[i - 1].flow + s * table[i].flow;
  }
  return table.back().flow;
}

}  // namespace vacuum_gripper_sim
