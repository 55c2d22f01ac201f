#include "step_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace vacuum_gripper_sim {
namespace {

double Sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

void ReportTimes(const std::string& clock, const std::vector<double>& times,
                 benchmark::State* state) {
  state->counters[clock + "_mean"] = 1e3 * Sum(times) / static_cast<double>(times.size());
  state->counters[clock + "_median"] = 1e3 * Quantile(times, 0.5);
  state->counters[clock + "_p99"] = 1e3 * Quantile(times, 0.99);
  state->counters[clock + "_max"] = 1e3 * Quantile(times, 1.0);
}

}  // namespace

double Quantile(std::vector<double> values, double share) {
  const auto rank =
      static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

double StepStatistics::total_cpu() const { return Sum(cpu_); }

void StepStatistics::Report(const std::vector<std::pair<std::string, double>>& phases,
                            benchmark::State* state) const {
  state->counters["yardstick"] = 1e3 * 0.5 * (yardstick_ + Yardstick());
  ReportTimes("cpu", cpu_, state);
  ReportTimes("wall", wall_, state);
  for (const auto& [name, seconds] : phases) {
    state->counters["phase_" + name] = 1e3 * seconds / static_cast<double>(cpu_.size());
  }
}

}  // namespace vacuum_gripper_sim
