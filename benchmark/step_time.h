#pragma once

#include "grip_situation.h"
#include "thread_time.h"
#include "vacuum_gripper_sim/core/stopwatch.h"

namespace vacuum_gripper_sim {

struct StepTime {
  double cpu, wall;  ///< Of the calling thread; of the clock. [s]
};

/// Makes a situation's next step.
inline StepTime TimeStep(GripSituation* grip) {
  StepTime time{};
  const double begin = ThreadTime();
  {
    const Stopwatch stopwatch(&time.wall);
    grip->Step();
  }
  time.cpu = ThreadTime() - begin;
  return time;
}

}  // namespace vacuum_gripper_sim
