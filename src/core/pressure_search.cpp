#include "vacuum_gripper_sim/core/pressure_search.h"

#include <algorithm>

namespace vacuum_gripper_sim {

double PressureSearch::Next(double p, double f) {
  // A root that a cup with a lip about to open has: flatter ones lead far away, steeper ones
  // nowhere.
  constexpr double kFlattest = -0.1, kSteepest = -100.0;
  const double r = f - p;
  if (r > 0.0) low_ = low_ ? std::max(*low_, p) : p;
  if (r < 0.0) high_ = high_ ? std::min(*high_, p) : p;
  if (last_p_ && p != *last_p_) {
    const double slope = (r - *last_r_) / (p - *last_p_);
    if (slope < 0.0) slope_ = std::clamp(slope, kSteepest, kFlattest);
  }
  last_p_ = p;
  last_r_ = r;
  const double next = p - r / slope_;
  const bool is_bracketed = low_ && high_ && *low_ < *high_;
  return is_bracketed && !(next > *low_ && next < *high_) ? 0.5 * (*low_ + *high_) : next;
}

}  // namespace vacuum_gripper_sim
