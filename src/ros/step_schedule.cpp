#include "step_schedule.h"

#include <algorithm>
#include <cmath>

namespace vacuum_gripper_sim {
namespace {

constexpr double kWallClockCorrection = 1.0;  // [s]
constexpr double kClockPolling = 5e-4;        // [s]; a new /clock wakes nobody up.
constexpr double kRounding = 1e-6;  // A clock that ticks by h ticks by h minus rounding. [s]

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
  const double advance = (now - last_).toSec();
  last_ = now;
  if (advance < -tolerance) {
    next_ = now + time_step_;
    return Event::kJumpedBack;
  }
  if (advance < 0.0) next_ = now + time_step_;

  const double late = (now - next_).toSec();
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
  const double late = (now - next_).toSec();
  if (simulated_clock_) return true;  // Its clock is paced by others.
  if (late > time_step_.toSec()) next_ = now;
  return late <= 0.0;
}

ros::WallDuration StepSchedule::TimeToWait(const ros::Time& now) const {
  if (!started_) return ros::WallDuration(kClockPolling);
  const double wait = (next_ - now).toSec();
  if (simulated_clock_) return ros::WallDuration(wait < kRounding ? 0.0 : kClockPolling);
  return ros::WallDuration(std::clamp(wait, 0.0, time_step_.toSec()));
}

}  // namespace vacuum_gripper_sim
