#pragma once

#include <vector>

namespace vacuum_gripper_sim {

/// Wall times of the steps of a while, each with the part of it that went into publishing.
class StepTimes {
 public:
  /// @param total Of the step, publishing included. [s] @param publishing [s]
  void Add(double total, double publishing);
  /// Forgets all steps; keeps their memory.
  void Clear();

  int count() const { return static_cast<int>(totals_.size()); }
  double Mean() const;  ///< [s]; like the others 0 without steps.
  double Max() const;   ///< [s]
  /// The smallest time that at least `share` of the steps did not exceed ("nearest rank"). [s]
  /// @param share 0 < share <= 1.
  double Percentile(double share);
  /// Of all the steps' time. [-]
  double PublishingShare() const;

 private:
  std::vector<double> totals_;  // [s], in no order
  double sum_{0.0};             // [s]
  double publishing_{0.0};      // [s]
};

}  // namespace vacuum_gripper_sim
