#include "step_times.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vacuum_gripper_sim {

void StepTimes::Add(const StepTime& time) {
  totals_.push_back(time.total);
  sum_.total += time.total;
  sum_.posting += time.posting;
  sum_.publishing += time.publishing;
}

void StepTimes::Clear() {
  totals_.clear();
  sum_ = StepTime();
}

double StepTimes::Mean() const { return totals_.empty() ? 0.0 : sum_.total / count(); }

double StepTimes::Max() const {
  return totals_.empty() ? 0.0 : *std::max_element(totals_.begin(), totals_.end());
}

double StepTimes::Percentile(double share) {
  if (totals_.empty()) return 0.0;
  const int rank = std::clamp(static_cast<int>(std::ceil(share * count())), 1, count());
  const auto place = totals_.begin() + (rank - 1);
  std::nth_element(totals_.begin(), place, totals_.end());
  return *place;
}

double StepTimes::PostingShare() const {
  return sum_.total > 0.0 ? sum_.posting / sum_.total : 0.0;
}

double StepTimes::PublishingShare() const {
  return sum_.total > 0.0 ? sum_.publishing / sum_.total : 0.0;
}

}  // namespace vacuum_gripper_sim
