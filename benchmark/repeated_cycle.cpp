#include "repeated_cycle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "grip_situation.h"
#include "step_statistics.h"
#include "step_time.h"
#include "thread_clock.h"

namespace vacuum_gripper_sim {

void TimeRepeatedCycle(benchmark::State& state, const std::string& bell, double rate,
                       LinearSolverMethod method, int threads) {
  constexpr double kSeconds = 2.5;  // until it is pressed again
  const double period = 1.0 / rate;
  std::vector<StepTime> best;
  StepStatistics statistics;
  double elements = 0.0;
  for (auto _ : state) {
    GripSituation grip(bell, Situation::kCycle, method, threads, period);
    const OnOneCore on_one_core;
    const auto num_steps = static_cast<std::size_t>(std::lround(kSeconds * rate));
    for (std::size_t i = 0; i < num_steps; ++i) {
      const StepTime time = TimeStep(&grip);
      if (i == best.size()) best.push_back(time);
      best[i].cpu = std::min(best[i].cpu, time.cpu);
      best[i].wall = std::min(best[i].wall, time.wall);
    }
    elements = grip.cycle().simulator().mesh().num_elements();
  }
  double over_period = 0.0, longest = 0.0;
  for (const StepTime& time : best) {
    statistics.Add(time.cpu, time.wall);
    if (time.wall > period) ++over_period;
    longest = std::max(longest, time.wall);
  }
  statistics.Report({}, &state);
  state.counters["elements"] = elements;
  state.counters["steps"] = static_cast<double>(best.size());
  state.counters["over_period"] = over_period;
  state.counters["worst_share"] = longest / period;
}

}  // namespace vacuum_gripper_sim
