#pragma once

#include <ros/duration.h>
#include <ros/time.h>

namespace vacuum_gripper_sim {

/** Says when the next step of h is due, in ROS time.

 - Wall clock: a step every h. A step that ends after its period is a missed deadline; once the
   loop is a whole period behind it starts afresh from now, so the simulation falls back and never
   hurries by more than one step.
 - Simulated clock: a step for every h the clock advances. After a leap of more than
   kMaxBacklog steps the rest of the leap is skipped (and counted).
 - A clock that jumps back starts the schedule afresh and is reported once. On the wall clock,
   corrections of less than a second only shift the schedule. */
class StepSchedule {
 public:
  enum class Event { kWait, kStep, kJumpedBack };
  static constexpr int kMaxBacklog = 20;

  /// @param time_step h [s].
  StepSchedule(double time_step, bool simulated_clock)
      : time_step_(time_step), simulated_clock_(simulated_clock) {}

  /// What is due at `now`.
  Event Poll(const ros::Time& now);
  /// To be called after the step that Poll() asked for. True if it met its deadline.
  bool OnStepFinished(const ros::Time& now);

  /// Time stamp of the step that is due: when it was due on a simulated clock (several steps may
  /// share one reading of the clock), `now` otherwise.
  ros::Time StampOfStep(const ros::Time& now) const { return simulated_clock_ ? next_ : now; }
  /// How long callbacks may be waited for. [wall s]
  ros::WallDuration TimeToWait(const ros::Time& now) const;
  /// Steps' worth of simulated time that were skipped.
  long skipped_steps() const { return skipped_steps_; }

 private:
  ros::Duration time_step_;
  bool simulated_clock_;
  bool started_{false};
  ros::Time next_;  // When the next step is due.
  ros::Time last_;  // Last reading of the clock.
  long skipped_steps_{0};
};

}  // namespace vacuum_gripper_sim
