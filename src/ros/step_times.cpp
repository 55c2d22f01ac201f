#include "step_times.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vacuum_gripper_sim {

void StepTimes::Add(const StepCost& cost) {
  walls_.push_back(cost.wall);
  sum_.wall += cost.wall;
  sum_.posting += cost.posting;
  sum_.computing += cost.computing;
  sum_.publishing += cost.publishing;
}

void StepTimes::Clear() {
  walls_.clear();
  sum_ = StepCost();
}

double StepTimes::Mean() const { return walls_.empty() ? 0.0 : sum_.wall / count(); }

double StepTimes::Max() const {
  return walls_.empty() ? 0.0 : *std::max_element(walls_.begin(), walls_.end());
}

double StepTimes::Percentile(double share) {
  if (walls_.empty()) return 0.0;
  const int rank = std::clamp(static_cast<int>(std::ceil(share * count())), 1, count());
  const auto place = walls_.begin() + (rank - 1);
  std::nth_element(walls_.begin(), place, walls_.end());
  return *place;
}

double StepTimes::PostingShare() const { return sum_.wall > 0.0 ? sum_.posting / sum_.wall : 0.0; }

double StepTimes::PublishingShare() const {
  return sum_.wall > 0.0 ? sum_.publishing / sum_.wall : 0.0;
}

}  // namespace vacuum_gripper_sim
