#pragma once

#include <time.h>

namespace vacuum_gripper_sim {

/// CPU time of the calling thread: what a step costs, however busy the machine is. [s]
inline double ThreadTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace vacuum_gripper_sim
