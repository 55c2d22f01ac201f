#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <utility>
#include <vector>

#include "yardstick.h"

namespace vacuum_gripper_sim {

/// The smallest value that is not below `share` of all.
double Quantile(std::vector<double> values, double share);

/// Times of the steps of one case, and what is reported of them. Made before the first step and
/// reported after the last, it measures the yardstick at both ends.
class StepStatistics {
 public:
  StepStatistics() : yardstick_(Yardstick()) {}

  /// @param cpu,wall Thread-CPU and wall time of a step. [s]
  void Add(double cpu, double wall) {
    cpu_.push_back(cpu);
    wall_.push_back(wall);
  }
  double total_cpu() const;  ///< [s]

  /** Sets the counters cpu_mean, cpu_median, cpu_p99 and cpu_max, wall_mean, wall_median, wall_p99
   and wall_max, yardstick, and phase_<name> for each phase's mean. [ms]
   @param phases Name and time over all steps [s]. */
  void Report(const std::vector<std::pair<std::string, double>>& phases,
              benchmark::State* state) const;

 private:
  double yardstick_;
  std::vector<double> cpu_, wall_;
};

}  // namespace vacuum_gripper_sim
