#include "vacuum_gripper_sim/core/gas_flow.h"

#include <algorithm>
#include <cmath>

namespace vacuum_gripper_sim {
namespace {

/// psi of OrificeThroughput(), of r = p_d / p_u.
double Outflow(double r) {
  constexpr double g = air::kHeatRatio;
  constexpr double kLinearFrom = 0.999;
  static const double kCritical = std::pow(2.0 / (g + 1.0), g / (g - 1.0));
  if (r > kLinearFrom) return Outflow(kLinearFrom) * (1.0 - r) / (1.0 - kLinearFrom);
  r = std::max(r, kCritical);
  return std::sqrt(2.0 * g / (g - 1.0) * (std::pow(r, 2.0 / g) - std::pow(r, (g + 1.0) / g)));
}

}  // namespace

double OrificeThroughput(double area, double p_from, double p_to) {
  if (p_from < p_to) return -OrificeThroughput(area, p_to, p_from);
  if (p_from <= 0.0) return 0.0;
  static const double kSpeed = std::sqrt(air::kGasConstant * air::kTemperature);  // m/s
  return area * p_from * kSpeed * Outflow(p_to / p_from);
}

double SlitThroughput(double shape, double p_from, double p_to) {
  return (p_from - p_to) * (p_from + p_to) / (24.0 * air::kViscosity) * shape;
}

}  // namespace vacuum_gripper_sim
