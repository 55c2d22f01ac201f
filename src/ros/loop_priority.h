#pragma once

#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace vacuum_gripper_sim {

/// How Linux schedules the calling thread: "normal", "SCHED_FIFO 50" and the like.
std::string SchedulingOfThisThread();

/// Says when a loop that should sleep between two steps has not done so for a second.
class RestWatch {
 public:
  /// Before every sleep. @param sleep How long it will be. @param now Of any clock. [s]
  /// @return True if none was longer than zero for a second. A single stall of the process is none.
  bool IsRestless(double sleep, double now);

 private:
  double busy_{0.0};  // Time without sleep. [s]
  std::optional<double> last_;
};

/** The priority of a loop's thread, which is the one that makes this object, and of helpers that it
 waits for: one that a normal thread keeps from its core would make the loop as late as if it had no
 priority itself.

 SCHED_FIFO goes before all that is scheduled normally, on the loop's core and for as long as it
 does not sleep: a loop whose steps take longer than their period would keep everybody else from
 that core. So a loop that has found no time to sleep for a second gets normal scheduling for good.
 Threads that it makes begin with normal scheduling.

 Whatever the priority, Linux's allowance of 50 us for waking up a normal thread late is cut. */
class LoopPriority {
 public:
  static constexpr int kHighest = 99;

  /// @param priority Of SCHED_FIFO, 1 .. kHighest; 0: scheduled as the process was started.
  /// @param helpers Get the same, and must outlive this.
  explicit LoopPriority(int priority, std::vector<std::thread::native_handle_type> helpers = {});

  /// What the system said if it did not grant the priority; empty otherwise.
  const std::string& refusal() const { return refusal_; }
  /// Whether the thread has it.
  bool held() const { return held_; }
  /// Before every sleep. @param sleep How long it will be. @param now Of any clock. [s]
  /// @return True if the priority was given up just now.
  bool OnSleep(double sleep, double now);

 private:
  int SetScheduler(int policy, int priority);

  std::vector<std::thread::native_handle_type> helpers_;
  bool held_{false};
  std::string refusal_;
  RestWatch watch_;
};

}  // namespace vacuum_gripper_sim
