#include "vacuum_gripper_sim/core/step_result.h"

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
  }
  return "unknown";
}

}  // namespace vacuum_gripper_sim
