#include "vacuum_gripper_sim/core/step_result.h"

#include <algorithm>

namespace vacuum_gripper_sim {

const char* NameOf(SealStatus status) {
  switch (status) {
    case SealStatus::kOpen:
      return "open";
    case SealStatus::kSealed:
      return "sealed";
    case SealStatus::kRegulating:
      return "regulating";
    case SealStatus::kLost:
      return "lost";
    case SealStatus::kLeaking:
      return "leaking";
  }
  return "unknown";
}

bool Holds(SealStatus status) {
  return status == SealStatus::kSealed || status == SealStatus::kRegulating ||
         status == SealStatus::kLeaking;
}

GripSummary SumOf(const std::vector<CupResult>& cups) {
  GripSummary sum;
  const auto count = [&](SealStatus status) {
    return std::count_if(cups.begin(), cups.end(),
                         [&](const CupResult& cup) { return cup.status == status; });
  };
  // Those that hold speak for the gripper.
  for (const SealStatus status :
       {SealStatus::kLeaking, SealStatus::kRegulating, SealStatus::kSealed, SealStatus::kLost}) {
    if (count(status) == 0) continue;
    sum.status = status;
    break;
  }
  bool first = true;
  for (const CupResult& cup : cups) {
    sum.gauge_pressure =
        first ? cup.gauge_pressure : std::min(sum.gauge_pressure, cup.gauge_pressure);
    if (first || cup.bottleneck_gap > sum.bottleneck_gap) {
      sum.bottleneck_gap = cup.bottleneck_gap;
      sum.opening = cup.opening;
    }
    first = false;
    sum.cavity_area += cup.cavity_area;
    sum.cavity_volume += cup.cavity_volume;
    sum.contact_force += cup.contact_force;
    sum.num_contacts += cup.num_contacts;
    sum.leak_flow += cup.leak_flow;
    sum.leak_area += cup.leak_area;
    for (std::size_t zone = 0; zone < sum.zone_counts.size(); ++zone) {
      sum.zone_counts[zone] += cup.zone_counts[zone];
    }
  }
  return sum;
}

}  // namespace vacuum_gripper_sim
