#pragma once

#include <benchmark/benchmark.h>

#include <string>

#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

/// Runs that TimeRepeatedCycle() wants, a benchmark's iterations.
constexpr int kRunsOfCycle = 5;

/** Every step of a whole cycle (press, seal, pull off, vent, press again) at its best of several
 runs. They take the same steps with the same numbers: what one takes longer than another does is
 the machine's doing, and what a step takes in all of them is the step's own. Sets the counters of
 StepStatistics, of the best times, and `steps`, `over_period`, of the steps those whose best wall
 time is longer than the period, and `worst_share`, the longest over the period.
 @param bell Name of one of meshes/bell_*.msh. @param rate Of the loop. [Hz]
 @param method kDirect or kConjugateGradient: asynchronous steps differ from run to run. */
void TimeRepeatedCycle(benchmark::State& state, const std::string& bell, double rate,
                       LinearSolverMethod method, int threads);

}  // namespace vacuum_gripper_sim
