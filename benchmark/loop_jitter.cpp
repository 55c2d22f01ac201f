// How well this machine keeps time just now: a loop at a rate that sleeps until its next period is
// due, and then computes for a part of it. What it misses, no node that sleeps can keep.

#include <time.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <string>

#include "loop_priority.h"
#include "thread_clock.h"
#include "yardstick.h"

namespace vacuum_gripper_sim {
namespace {

struct Arguments {
  double rate, duty, seconds;
  int priority;
};

double ReadNumber(const char* name, const std::string& text, double minimum, double maximum) {
  std::size_t length = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &length);
  } catch (const std::exception&) {
    length = 0;
  }
  if (text.empty() || length != text.size() || !(value >= minimum && value <= maximum)) {
    std::ostringstream reason;
    reason << name << " = '" << text << "' must be a number from " << minimum << " to " << maximum;
    throw std::invalid_argument(reason.str());
  }
  return value;
}

Arguments ReadArguments(int argc, char** argv) {
  if (argc != 5) {
    throw std::invalid_argument(
        "usage: loop_jitter RATE DUTY SECONDS PRIORITY\n"
        "  RATE [Hz], DUTY share of a period to compute, PRIORITY of SCHED_FIFO or 0");
  }
  return {ReadNumber("RATE", argv[1], 10.0, 1.0e+4), ReadNumber("DUTY", argv[2], 0.0, 0.9),
          ReadNumber("SECONDS", argv[3], 0.0, 1.0e+6),
          static_cast<int>(ReadNumber("PRIORITY", argv[4], 0.0, LoopPriority::kHighest))};
}

std::int64_t Now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1000000000} * now.tv_sec + now.tv_nsec;
}

void SleepUntil(std::int64_t time) {
  timespec until{};
  until.tv_sec = time / 1000000000;
  until.tv_nsec = time % 1000000000;
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

void Compute(double seconds) {
  const double end = ThreadTime() + seconds;
  volatile double value = 0.0;
  while (ThreadTime() < end) {
    for (int i = 0; i < 1000; ++i) value = 0.5 * value + 1.0;  // asking the clock is a system call
  }
}

/// Share of the periods that ended late. A loop that is a whole period behind starts afresh, as the
/// node's does.
double MissedShare(const Arguments& arguments) {
  const auto period = static_cast<std::int64_t>(1e9 / arguments.rate);
  const auto periods = static_cast<std::int64_t>(arguments.seconds * arguments.rate);
  std::int64_t missed = 0;
  std::int64_t next = Now() + period;
  for (std::int64_t i = 0; i < periods; ++i) {
    SleepUntil(next);
    Compute(arguments.duty / arguments.rate);
    next += period;
    const std::int64_t late = Now() - next;
    if (late > 0) ++missed;
    if (late > period) next += late;
  }
  return periods > 0 ? static_cast<double>(missed) / static_cast<double>(periods) : 0.0;
}

}  // namespace
}  // namespace vacuum_gripper_sim

int main(int argc, char** argv) {
  using namespace vacuum_gripper_sim;
  try {
    const Arguments arguments = ReadArguments(argc, argv);
    const double yardstick = Yardstick();
    const LoopPriority priority(arguments.priority);
    const double missed = MissedShare(arguments);
    std::printf("missed_percent=%.4f yardstick_ms=%.3f scheduling='%s'\n", 100.0 * missed,
                1e3 * yardstick, SchedulingOfThisThread().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "loop_jitter: %s\n", error.what());
    return 2;
  }
  return 0;
}
