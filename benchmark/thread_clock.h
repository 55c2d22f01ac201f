#pragma once

#include <pthread.h>
#include <sched.h>

#include "thread_time.h"

namespace vacuum_gripper_sim {

/// Adds the CPU time that its thread takes during its life to a counter.
class ThreadStopwatch {
 public:
  explicit ThreadStopwatch(double* seconds) : seconds_(seconds) {}
  ~ThreadStopwatch() { *seconds_ += ThreadTime() - start_; }
  ThreadStopwatch(const ThreadStopwatch&) = delete;
  ThreadStopwatch& operator=(const ThreadStopwatch&) = delete;

 private:
  double* seconds_;
  double start_{ThreadTime()};
};

/// Keeps the calling thread on the last of the cores that it may use, so that nothing it times pays
/// for a move. Threads made before or after this object's life go where they like.
class OnOneCore {
 public:
  OnOneCore() {
    pthread_getaffinity_np(pthread_self(), sizeof(allowed_), &allowed_);
    int last = CPU_SETSIZE - 1;
    while (last > 0 && !CPU_ISSET(last, &allowed_)) --last;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(last, &one);
    pthread_setaffinity_np(pthread_self(), sizeof(one), &one);
  }
  ~OnOneCore() { pthread_setaffinity_np(pthread_self(), sizeof(allowed_), &allowed_); }
  OnOneCore(const OnOneCore&) = delete;
  OnOneCore& operator=(const OnOneCore&) = delete;

 private:
  cpu_set_t allowed_{};
};

}  // namespace vacuum_gripper_sim
