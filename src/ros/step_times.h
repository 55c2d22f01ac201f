#pragma once

#include <vector>

namespace vacuum_gripper_sim {

/// What a step took. [s]
struct StepCost {
  double wall{0.0};
  double posting{0.0};     ///< Of it: handing the results over to the thread that publishes them.
  double computing{0.0};   ///< CPU time of the loop's thread.
  double publishing{0.0};  ///< CPU time meanwhile of the thread that publishes.
};

/// Times of the steps of a while, and of what was published beside them.
class StepTimes {
 public:
  void Add(const StepCost& cost);
  /// Forgets all steps; keeps their memory.
  void Clear();

  int count() const { return static_cast<int>(walls_.size()); }
  double Mean() const;  ///< [s]; like the others 0 without steps.
  double Max() const;   ///< [s]
  /// The smallest time that at least `share` of the steps did not exceed ("nearest rank"). [s]
  /// @param share 0 < share <= 1.
  double Percentile(double share);
  /// Of handing results over, in all the steps' time. [-]
  double PostingShare() const;
  /// Of publishing, over all the steps' time. [-]
  double PublishingShare() const;

 private:
  std::vector<double> walls_;  // [s], in no order
  StepCost sum_;
};

}  // namespace vacuum_gripper_sim
