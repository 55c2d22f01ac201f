#include "core_follower.h"

#include <cstddef>

namespace vacuum_gripper_sim {

CoreFollower::CoreFollower(pthread_t thread)
    : thread_(thread),
      knows_anywhere_(pthread_getaffinity_np(pthread_self(), sizeof(anywhere_), &anywhere_) == 0) {}

void CoreFollower::Follow() {
  const int core = sched_getcpu();
  if (!knows_anywhere_ || core < 0 || core == core_) return;
  if (!CPU_ISSET(static_cast<std::size_t>(core), &anywhere_)) return LetGo();
  cpu_set_t own;
  CPU_ZERO(&own);
  CPU_SET(static_cast<std::size_t>(core), &own);
  MoveTo(core, own);
}

void CoreFollower::LetGo() {
  if (core_ != kAnyCore) MoveTo(kAnyCore, anywhere_);
}

/// If the system refuses, the thread stays where it may be, which only costs time.
void CoreFollower::MoveTo(int core, const cpu_set_t& cores) {
  pthread_setaffinity_np(thread_, sizeof(cores), &cores);
  core_ = core;
}

}  // namespace vacuum_gripper_sim
