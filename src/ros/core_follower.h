#pragma once

#include <pthread.h>
#include <sched.h>

namespace vacuum_gripper_sim {

/** Keeps a thread on the core of another one that wakes it up and then rests.

 Waking a thread on another core interrupts that core, which on a virtual machine takes as long as
 its host likes: some 40 us have been seen, where a step took 200; on the own core it takes 6. */
class CoreFollower {
 public:
  /// @param thread Must outlive the use of this. It may run wherever the caller may.
  explicit CoreFollower(pthread_t thread);

  /// From now on the thread runs on the calling thread's core; where it may not run there, anywhere
  /// it may.
  void Follow();
  /// From now on it runs where it likes, as in the beginning.
  void LetGo();

 private:
  static constexpr int kAnyCore = -1;

  void MoveTo(int core, const cpu_set_t& cores);

  pthread_t thread_;
  cpu_set_t anywhere_{};
  bool knows_anywhere_;  // False on a machine of more cores than a cpu_set_t has: never follows.
  int core_{kAnyCore};
};

}  // namespace vacuum_gripper_sim
