#include "step_schedule.h"

#include <gtest/gtest.h>

namespace vacuum_gripper_sim {
namespace {

using Event = StepSchedule::Event;
constexpr double kTimeStep = 0.01;

ros::Time At(double seconds) { return ros::Time(100.0 + seconds); }

// Steps until nothing is due any more; steps take no time.
int CountSteps(StepSchedule* schedule, double seconds) {
  int steps = 0;
  while (schedule->Poll(At(seconds)) == Event::kStep) {
    ++steps;
    EXPECT_TRUE(schedule->OnStepFinished(At(seconds)));
  }
  return steps;
}

TEST(StepSchedule, SimulatedClockStepsOnceForEveryH) {
  StepSchedule schedule(kTimeStep, true);
  EXPECT_EQ(CountSteps(&schedule, 0.0), 0);  // the first reading starts the count
  EXPECT_EQ(CountSteps(&schedule, 0.009), 0);
  EXPECT_EQ(CountSteps(&schedule, 0.010), 1);
  EXPECT_EQ(CountSteps(&schedule, 0.010), 0);  // paused
  EXPECT_EQ(CountSteps(&schedule, 0.055), 4);
  EXPECT_EQ(CountSteps(&schedule, 0.060), 1);
  EXPECT_EQ(schedule.skipped_steps(), 0);
}

TEST(StepSchedule, SimulatedClockIsSilentBeforeItsFirstReading) {
  StepSchedule schedule(kTimeStep, true);
  EXPECT_EQ(schedule.Poll(ros::Time(0.0)), Event::kWait);
  EXPECT_EQ(CountSteps(&schedule, 50.0), 0);
  EXPECT_EQ(CountSteps(&schedule, 50.01), 1);
}

TEST(StepSchedule, StampsOfOneLeapDiffer) {
  StepSchedule schedule(kTimeStep, true);
  schedule.Poll(At(0.0));
  for (const double stamp : {0.01, 0.02, 0.03}) {
    ASSERT_EQ(schedule.Poll(At(0.03)), Event::kStep);
    EXPECT_NEAR((schedule.StampOfStep(At(0.03)) - At(stamp)).toSec(), 0.0, 1e-8);
    schedule.OnStepFinished(At(0.03));
  }
}

TEST(StepSchedule, HugeLeapIsBounded) {
  StepSchedule schedule(kTimeStep, true);
  schedule.Poll(At(0.0));
  EXPECT_EQ(CountSteps(&schedule, 10.0), StepSchedule::kMaxBacklog);
  EXPECT_EQ(schedule.skipped_steps(), 1000 - StepSchedule::kMaxBacklog);
  EXPECT_EQ(CountSteps(&schedule, 10.01), 1);
}

TEST(StepSchedule, JumpBackIsToldOnceAndStartsAfresh) {
  StepSchedule schedule(kTimeStep, true);
  schedule.Poll(At(5.0));
  EXPECT_EQ(schedule.Poll(At(4.999)), Event::kJumpedBack);
  EXPECT_EQ(schedule.Poll(At(4.999)), Event::kWait);
  EXPECT_EQ(CountSteps(&schedule, 5.009), 1);
}

// Steps of 4, 12, 7 and 50 ms from t = 0.01 on.
TEST(StepSchedule, WallClockCountsMissedDeadlinesAndFallsBack) {
  StepSchedule schedule(kTimeStep, false);
  schedule.Poll(At(0.0));
  ASSERT_EQ(schedule.Poll(At(0.010)), Event::kStep);
  EXPECT_TRUE(schedule.OnStepFinished(At(0.014)));
  EXPECT_EQ(schedule.Poll(At(0.019)), Event::kWait);
  EXPECT_NEAR(schedule.TimeToWait(At(0.019)).toSec(), 0.001, 1e-8);
  ASSERT_EQ(schedule.Poll(At(0.020)), Event::kStep);
  EXPECT_FALSE(schedule.OnStepFinished(At(0.032)));  // its period ended at 0.030
  ASSERT_EQ(schedule.Poll(At(0.032)), Event::kStep);
  EXPECT_TRUE(schedule.OnStepFinished(At(0.039)));  // caught up
  ASSERT_EQ(schedule.Poll(At(0.040)), Event::kStep);
  EXPECT_FALSE(schedule.OnStepFinished(At(0.090)));
  // Four periods are lost, not made up for: one step now, the next an h later.
  ASSERT_EQ(schedule.Poll(At(0.090)), Event::kStep);
  EXPECT_TRUE(schedule.OnStepFinished(At(0.094)));
  EXPECT_EQ(schedule.Poll(At(0.095)), Event::kWait);
  EXPECT_EQ(schedule.Poll(At(0.100)), Event::kStep);
}

TEST(StepSchedule, CorrectionOfTheWallClockIsNoJump) {
  StepSchedule schedule(kTimeStep, false);
  schedule.Poll(At(5.0));
  EXPECT_EQ(schedule.Poll(At(4.9)), Event::kWait);
  EXPECT_EQ(schedule.Poll(At(4.91)), Event::kStep);
  EXPECT_TRUE(schedule.OnStepFinished(At(4.912)));
  EXPECT_EQ(schedule.Poll(At(3.0)), Event::kJumpedBack);
}

}  // namespace
}  // namespace vacuum_gripper_sim
