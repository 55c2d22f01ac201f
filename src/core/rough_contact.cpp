#include "vacuum_gripper_sim/core/rough_contact.h"

#include <cmath>

namespace vacuum_gripper_sim {

double HydraulicGap(double h_rms, double contact_pressure, double reduced_modulus) {
  using namespace rough_contact;
  const double scale = kBeta * reduced_modulus;
  static const double kUnloaded = 1.0 / std::expm1(kAlpha * kHighestPeak);  // p_0 / scale
  const double separation =
      std::log1p(1.0 / (contact_pressure / scale + kUnloaded)) / kAlpha;  // u / h_rms
  const double flow_factor = 1.0 - 0.9 * std::exp(-0.56 * separation);
  return h_rms * separation * std::cbrt(flow_factor);
}

}  // namespace vacuum_gripper_sim
