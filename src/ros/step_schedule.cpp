#include "step_schedule.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vacuum_gripper_sim {
namespace {

constexpr double kWallClockCorrection = 1.0;  // [s]
constexpr double kClockPolling = 5e-4;        // [s]; a new /clock wakes nobody up.
constexpr double kLongestLeap = 1e+6;         // [s]; a longer one starts the schedule afresh.
constexpr double kRounding = 1e-6;  // A clock that ticks by h ticks by h minus rounding. [s]

/// a - b [s]. Where ros::Time's own difference is out of range, beyond 68 years, it throws.
double Seconds(const ros::Time& a, const ros::Time& b) {
  const auto nanoseconds =
      static_cast<std::int64_t>(a.toNSec()) - static_cast<std::int64_t>(b.toNSec());
  return 1e-9 * static_cast<double>(nanoseconds);
}

}  // namespace

StepSchedule::Event StepSchedule::Poll(const ros::Time& now) {
  if (now.isZero() && !started_) return Event::kWait;  // No /clock yet.
  if (!started_) {
    started_ = true;
    last_ = now;
    next_ = now + time_step_;
    return Event::kWait;
  }

  const double tolerance = simulated_clock_ ? 0.0 : kWallClockCorrection;
  const double advance = Seconds(now, last_);
  last_ = now;
  if (advance < -tolerance) {
    next_ = now + time_step_;
    return Event::kJumpedBack;
  }
  if (advance < 0.0) next_ = now + time_step_;
  if (advance > kLongestLeap) {
    next_ = now + time_step_;
    return Event::kWait;
  }

  const double late = Seconds(now, next_);
  if (late < -kRounding) return Event::kWait;
  if (simulated_clock_) {
    const double backlog = std::floor((late + kRounding) / time_step_.toSec());
    const double excess = backlog + 1.0 - kMaxBacklog;
    if (excess > 0.0) {
      skipped_steps_ += static_cast<long>(excess);
      next_ += ros::Duration(excess * time_step_.toSec());
    }
  }
  return Event::kStep;
}

bool StepSchedule::OnStepFinished(const ros::Time& now) {
  next_ += time_step_;
  const double late = Seconds(now, next_);
  if (simulated_clock_) return true;  // Its clock is paced by others.
  if (late > time_step_.toSec()) next_ = now;
  return late <= 0.0;
}

ros::WallDuration StepSchedule::TimeToWait(const ros::Time& now) const {
  if (!started_) return ros::WallDuration(kClockPolling);
  const double wait = Seconds(next_, now);
  if (simulated_clock_) return ros::WallDuration(wait < kRounding ? 0.0 : kClockPolling);
  return ros::WallDuration(std::clamp(wait, 0.0, time_step_.toSec()));
}

}  // namespace vacuum_gripper_sim
