#include "vacuum_gripper_sim/core/cup_leak.h"

#include "vacuum_gripper_sim/core/gas_flow.h"

namespace vacuum_gripper_sim {

double CupLeak::Throughput(double p_from, double p_to) const {
  return lip.Throughput(p_from, p_to) + 0.5 * porosity * (p_from - p_to) * (p_from + p_to) +
         OrificeThroughput(hole_area, p_from, p_to);
}

double CupLeak::EquivalentArea(double p_from, double p_to) const {
  const double orifice = OrificeThroughput(1.0, p_from, p_to);
  return orifice == 0.0 ? 0.0 : Throughput(p_from, p_to) / orifice;
}

}  // namespace vacuum_gripper_sim
