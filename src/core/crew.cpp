#include "vacuum_gripper_sim/core/crew.h"

#include <chrono>

namespace vacuum_gripper_sim {
namespace {

/// Calls condition() until it holds or for a while: less than it takes to put a thread to sleep and
/// to wake it up is not worth that. @returns whether it holds.
template <typename Condition>
bool HoldsSoon(const Condition& condition) {
  constexpr std::chrono::microseconds kPatience(100);
  const auto end = std::chrono::steady_clock::now() + kPatience;
  do {
    for (int i = 0; i < 50; ++i) {
      if (condition()) return true;
    }
  } while (std::chrono::steady_clock::now() < end);
  return false;
}

}  // namespace

Crew::Crew(int size) : size_(size) {
  try {
    for (int member = 1; member < size; ++member) {
      helpers_.emplace_back([this, member] { Help(member); });
    }
  } catch (...) {
    Stop();
    throw;
  }
}

Crew::~Crew() { Stop(); }

void Crew::Stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
    ++num_calls_;
  }
  called_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

std::vector<std::thread::native_handle_type> Crew::HelperThreads() {
  std::vector<std::thread::native_handle_type> handles;
  handles.reserve(helpers_.size());
  for (std::thread& helper : helpers_) handles.push_back(helper.native_handle());
  return handles;
}

void Crew::Call(Function function, const void* work) {
  if (helpers_.empty()) {
    function(work, 0);
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    function_ = function;
    work_ = work;
    ++num_calls_;
  }
  called_.notify_all();
  function(work, 0);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    function_ = nullptr;  // nobody joins from here on
  }
  const auto all_left = [this] { return at_work_ == 0; };
  if (HoldsSoon(all_left)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  left_.wait(lock, all_left);
}

/// Until nothing is. Whoever does it may have to be let onto this core first.
void Crew::WaitFor(const std::atomic<int>& missing) {
  constexpr std::chrono::microseconds kNap(50);
  const auto is_done = [&] { return missing == 0; };
  if (HoldsSoon(is_done)) return;
  for (int i = 0; i < 10 && !is_done(); ++i) std::this_thread::yield();
  while (!is_done()) std::this_thread::sleep_for(kNap);
}

void Crew::Help(int member) {
  std::int64_t answered = 0;
  const auto is_called = [&] { return num_calls_ != answered; };
  while (true) {
    HoldsSoon(is_called);
    std::unique_lock<std::mutex> lock(mutex_);
    called_.wait(lock, is_called);
    if (stop_) return;
    answered = num_calls_;
    const Function function = function_;
    const void* const work = work_;
    if (function == nullptr) continue;  // too late
    ++at_work_;
    lock.unlock();
    function(work, member);
    lock.lock();
    if (--at_work_ == 0) left_.notify_one();
  }
}

}  // namespace vacuum_gripper_sim
