#include "loop_priority.h"

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

constexpr double kLongestWithoutRest = 1.0;  // [s]
constexpr double kLongestStep = 0.1;         // [s]; what takes longer was stopped from outside
constexpr unsigned long kTimerSlack = 1;     // [ns]; 0 would mean the default

}  // namespace

std::string SchedulingOfThisThread() {
  sched_param parameters{};
  sched_getparam(0, &parameters);
  const std::string priority = " " + std::to_string(parameters.sched_priority);
  switch (sched_getscheduler(0) & ~SCHED_RESET_ON_FORK) {
    case SCHED_FIFO:
      return "SCHED_FIFO" + priority;
    case SCHED_RR:
      return "SCHED_RR" + priority;
    case SCHED_BATCH:
      return "SCHED_BATCH";
    case SCHED_IDLE:
      return "SCHED_IDLE";
    default:
      return "normal";
  }
}

bool RestWatch::IsRestless(double sleep, double now) {
  const double passed = std::min(now - last_.value_or(now), kLongestStep);
  last_ = now;
  busy_ = sleep > 0.0 ? 0.0 : busy_ + passed;
  return busy_ > kLongestWithoutRest;
}

LoopPriority::LoopPriority(int priority, std::vector<std::thread::native_handle_type> helpers)
    : helpers_(std::move(helpers)) {
  prctl(PR_SET_TIMERSLACK, kTimerSlack);
  if (priority == 0) return;
  const int error = SetScheduler(SCHED_FIFO, priority);
  held_ = error == 0;
  if (!held_) refusal_ = std::generic_category().message(error);
}

/// @returns the error number of the first thread that was refused, or 0.
int LoopPriority::SetScheduler(int policy, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  for (const auto helper : helpers_) {
    const int error = pthread_setschedparam(helper, policy, &parameters);
    if (error != 0) return error;
  }
  // Threads made later must not inherit it. Only the privileged can take this flag back, so it
  // stays when the priority goes.
  return sched_setscheduler(0, policy | SCHED_RESET_ON_FORK, &parameters) == 0 ? 0 : errno;
}

bool LoopPriority::OnSleep(double sleep, double now) {
  if (!held_ || !watch_.IsRestless(sleep, now)) return false;
  SetScheduler(SCHED_OTHER, 0);
  held_ = false;
  return true;
}

}  // namespace vacuum_gripper_sim
