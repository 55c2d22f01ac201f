#pragma once

#include <vector>

namespace vacuum_gripper_sim {

/// Times of the steps of a while, and of what was published beside them.
class StepTimes {
 public:
  /// @param total Of the step, wall time. [s] @param publishing What publishing took meanwhile, CPU
  /// time. [s]
  void Add(double total, double publishing);
  /// Forgets all steps; keeps their memory.
  void Clear();

  int count() const { return static_cast<int>(totals_.size()); }
  double Mean() const;  ///< [s]; like the others 0 without steps.
  double Max() const;   ///< [s]
  /// The smallest time that at least `share` of the steps did not exceed ("nearest rank"). [s]
  /// @param share 0 < share <= 1.
  double Percentile(double share);
  /// Of publishing, over all the steps' time. [-]
  double PublishingShare() const;

 private:
  std::vector<double> totals_;  // [s], in no order
  double sum_{0.0};             // [s]
  double publishing_{0.0};      // [s]
};

}  // namespace vacuum_gripper_sim
