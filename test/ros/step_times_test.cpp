#include "step_times.h"

#include <gtest/gtest.h>

namespace vacuum_gripper_sim {
namespace {

StepCost Cost(double wall, double posting = 0.0, double publishing = 0.0) {
  StepCost cost;
  cost.wall = wall;
  cost.posting = posting;
  cost.publishing = publishing;
  return cost;
}

TEST(StepTimes, PercentileIsTheTimeThatTheShareOfStepsDidNotExceed) {
  StepTimes times;
  for (int i = 200; i >= 1; --i) times.Add(Cost(1e-3 * i));
  EXPECT_DOUBLE_EQ(times.Percentile(0.99), 0.198);
  EXPECT_DOUBLE_EQ(times.Percentile(0.5), 0.100);
  EXPECT_DOUBLE_EQ(times.Percentile(1.0), 0.200);
  EXPECT_DOUBLE_EQ(times.Max(), 0.200);  // nothing was lost in sorting
  EXPECT_NEAR(times.Mean(), 0.1005, 1e-12);
}

TEST(StepTimes, OneSlowStepInAHundredIsTheMaximumButNotThePercentile) {
  StepTimes times;
  times.Add(Cost(0.5));
  for (int i = 0; i < 99; ++i) times.Add(Cost(1e-3));
  EXPECT_DOUBLE_EQ(times.Percentile(0.99), 1e-3);
  times.Add(Cost(0.4));
  EXPECT_DOUBLE_EQ(times.Percentile(0.99), 0.4);
}

TEST(StepTimes, PostingAndPublishingAreSharesOfAllTime) {
  StepTimes times;
  times.Add(Cost(0.001));
  times.Add(Cost(0.003, 0.0005, 0.001));
  EXPECT_DOUBLE_EQ(times.PostingShare(), 0.125);
  EXPECT_DOUBLE_EQ(times.PublishingShare(), 0.25);
}

TEST(StepTimes, NothingIsZero) {
  StepTimes times;
  times.Add(Cost(1.0, 0.2, 0.5));
  times.Clear();
  EXPECT_EQ(times.count(), 0);
  EXPECT_EQ(times.Mean(), 0.0);
  EXPECT_EQ(times.Max(), 0.0);
  EXPECT_EQ(times.Percentile(0.99), 0.0);
  EXPECT_EQ(times.PostingShare(), 0.0);
  EXPECT_EQ(times.PublishingShare(), 0.0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
