#include "loop_priority.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <future>
#include <string>
#include <thread>

namespace vacuum_gripper_sim {
namespace {

// What a thread of its own sees, so that no other test runs with its priority.
template <typename Function>
void OnAThread(Function function) {
  std::thread(function).join();
}

// Steps of 10 ms without a wait. @return True as soon as the loop counts as restless.
template <typename Watched>
bool Hurry(double seconds, double* now, Watched is_restless) {
  const double end = *now + seconds;
  bool restless = false;
  for (; *now < end && !restless; *now += 0.01) restless = is_restless(0.0, *now);
  return restless;
}

TEST(RestWatch, OneSecondWithoutAWaitIsRestless) {
  RestWatch watch;
  double now = 100.0;
  const auto is_restless = [&](double wait, double time) { return watch.IsRestless(wait, time); };
  EXPECT_FALSE(Hurry(0.9, &now, is_restless));
  EXPECT_TRUE(Hurry(0.2, &now, is_restless));
}

TEST(RestWatch, EveryWaitBeginsANewSecond) {
  RestWatch watch;
  double now = 100.0;
  const auto is_restless = [&](double wait, double time) { return watch.IsRestless(wait, time); };
  EXPECT_FALSE(Hurry(0.9, &now, is_restless));
  EXPECT_FALSE(watch.IsRestless(1e-4, now));
  EXPECT_FALSE(Hurry(0.9, &now, is_restless));
  EXPECT_TRUE(Hurry(0.2, &now, is_restless));
}

TEST(RestWatch, OneStallIsNoHurry) {
  RestWatch watch;
  EXPECT_FALSE(watch.IsRestless(1e-3, 100.0));
  EXPECT_FALSE(watch.IsRestless(0.0, 200.0));
}

bool IsGivenUp(LoopPriority* priority) {
  double now = 100.0;
  return Hurry(2.0, &now, [&](double wait, double time) { return priority->OnSleep(wait, time); });
}

TEST(LoopPriority, ZeroLeavesTheScheduling) {
  OnAThread([] {
    const std::string before = SchedulingOfThisThread();
    LoopPriority priority(0);
    EXPECT_EQ(priority.refusal(), "");
    EXPECT_EQ(SchedulingOfThisThread(), before);
    EXPECT_FALSE(IsGivenUp(&priority));  // nothing to give up
  });
}

TEST(LoopPriority, NormalThreadsWakeWithoutSlack) {
  OnAThread([] {
    const LoopPriority priority(0);
    EXPECT_EQ(prctl(PR_GET_TIMERSLACK), 1);
  });
}

// Nobody is granted what does not exist, so this is refused whoever asks.
TEST(LoopPriority, RefusalIsToldAndLeavesTheScheduling) {
  OnAThread([] {
    const std::string before = SchedulingOfThisThread();
    LoopPriority priority(LoopPriority::kHighest + 1);
    EXPECT_NE(priority.refusal(), "");
    EXPECT_EQ(SchedulingOfThisThread(), before);
    EXPECT_FALSE(IsGivenUp(&priority));
  });
}

TEST(LoopPriority, IsOfItsThreadAloneAndGivenUpWithoutRest) {
  OnAThread([] {
    LoopPriority priority(7);
    if (!priority.refusal().empty()) {
      GTEST_SKIP() << "SCHED_FIFO is not allowed here: " << priority.refusal();
    }
    EXPECT_EQ(SchedulingOfThisThread(), "SCHED_FIFO 7");
    OnAThread([] { EXPECT_EQ(SchedulingOfThisThread(), "normal"); });
    EXPECT_TRUE(IsGivenUp(&priority));
    EXPECT_EQ(SchedulingOfThisThread(), "normal");
    EXPECT_FALSE(IsGivenUp(&priority));  // told once
  });
}

TEST(LoopPriority, HelpersShareIt) {
  std::promise<pid_t> begun;
  std::promise<void> end;
  std::thread helper([&] {
    begun.set_value(static_cast<pid_t>(syscall(SYS_gettid)));
    end.get_future().wait();
  });
  const pid_t id = begun.get_future().get();
  OnAThread([&] {
    LoopPriority priority(7, {helper.native_handle()});
    if (!priority.refusal().empty()) {
      GTEST_SKIP() << "SCHED_FIFO is not allowed here: " << priority.refusal();
    }
    EXPECT_EQ(sched_getscheduler(id), SCHED_FIFO);
    sched_param parameters{};
    EXPECT_EQ(sched_getparam(id, &parameters), 0);
    EXPECT_EQ(parameters.sched_priority, 7);
    EXPECT_TRUE(IsGivenUp(&priority));
    EXPECT_EQ(sched_getscheduler(id), SCHED_OTHER);
  });
  end.set_value();
  helper.join();
}

}  // namespace
}  // namespace vacuum_gripper_sim
