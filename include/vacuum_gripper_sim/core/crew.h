#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

namespace vacuum_gripper_sim {

/** Threads that do one piece of work at a time together: the one that has it, and helpers.

 Tasks are taken by whoever is free. Nobody waits for a helper that has not come: the others do all
 the tasks. So which thread does what differs from time to time, and results must not depend on
 it. One piece of work at a time. */
class Crew {
 public:
  /// @param size Threads, the caller's among them. >= 1. @throws std::system_error if the system
  /// has none left.
  explicit Crew(int size);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  int size() const { return size_; }
  /// For setting how they are scheduled: whoever has work waits for a helper that has begun.
  std::vector<std::thread::native_handle_type> HelperThreads();

  /// Tasks that depend on each other. Their numbers are such that children come before their
  /// parent.
  struct Forest {
    std::vector<int> parent;        ///< -1: none.
    std::vector<int> num_children;  ///< Of each task.
    std::vector<int> leaves;        ///< Tasks without children, in the order to begin them.
    std::vector<int> from_top;      ///< All, parents before their children, in the order to begin
                                    ///< them downwards.
  };

  /// Calls task(i, member) for 0 <= i < num_tasks, where member < size() tells the threads apart,
  /// and returns when all have returned. None may throw.
  template <typename Task>
  void Do(int num_tasks, const Task& task);
  /// The same for the tasks of a forest: each begins when all its children are done.
  template <typename Task>
  void Do(const Forest& forest, const Task& task);
  /// Each begins when its parent is done.
  template <typename Task>
  void DoDownwards(const Forest& forest, const Task& task);

 private:
  using Function = void (*)(const void* work, int member);

  /// Has all members call work(member) who come before the caller has returned from its own.
  template <typename Work>
  void CallOn(const Work& work) {
    Call([](const void* w, int member) { (*static_cast<const Work*>(w))(member); }, &work);
  }
  void Call(Function function, const void* work);
  static void WaitFor(const std::atomic<int>& missing);
  template <typename Number>
  void ExpectOf(const Forest& forest, const Number& number) {
    while (missing_.size() < forest.parent.size()) missing_.emplace_back(0);
    for (std::size_t i = 0; i < forest.parent.size(); ++i) missing_[i] = number(i);
  }
  void Help(int member);
  void Stop();

  int size_;
  std::mutex mutex_;  // for all that changes until next_; numbers may be looked at without it
  std::condition_variable called_, left_;
  Function function_{nullptr};              // of the work that helpers may still join
  const void* work_{nullptr};               // its first argument
  std::atomic<std::int64_t> num_calls_{0};  // so far; one more to stop
  std::atomic<int> at_work_{0};             // helpers
  bool stop_{false};

  std::atomic<int> next_{0};              // task to begin, by its place in a list
  std::deque<std::atomic<int>> missing_;  // by task: children to be done; downwards, itself

  std::vector<std::thread> helpers_;  // last: start when all else is there
};

template <typename Task>
void Crew::Do(int num_tasks, const Task& task) {
  if (num_tasks <= 1) {  // nobody needs to be called for that
    if (num_tasks == 1) task(0, 0);
    return;
  }
  next_ = 0;
  CallOn([&](int member) {
    for (int i = next_++; i < num_tasks; i = next_++) task(i, member);
  });
}

template <typename Task>
void Crew::Do(const Forest& forest, const Task& task) {
  next_ = 0;
  ExpectOf(forest, [&](std::size_t i) { return forest.num_children[i]; });
  const auto num_leaves = static_cast<int>(forest.leaves.size());
  const auto work = [&](int member) {
    for (int leaf = next_++; leaf < num_leaves; leaf = next_++) {
      // Whoever does the last child goes on to its parent.
      for (int i = forest.leaves[static_cast<std::size_t>(leaf)]; i >= 0;) {
        task(i, member);
        i = forest.parent[static_cast<std::size_t>(i)];
        if (i >= 0 && --missing_[static_cast<std::size_t>(i)] > 0) break;
      }
    }
  };
  if (num_leaves <= 1) {  // one after the other
    work(0);
  } else {
    CallOn(work);
  }
}

template <typename Task>
void Crew::DoDownwards(const Forest& forest, const Task& task) {
  next_ = 0;
  ExpectOf(forest, [](std::size_t /*i*/) { return 1; });
  const auto num_tasks = static_cast<int>(forest.from_top.size());
  const auto work = [&](int member) {
    for (int k = next_++; k < num_tasks; k = next_++) {
      const int i = forest.from_top[static_cast<std::size_t>(k)];
      // Somebody has begun it, for it comes before.
      const int parent = forest.parent[static_cast<std::size_t>(i)];
      if (parent >= 0) WaitFor(missing_[static_cast<std::size_t>(parent)]);
      task(i, member);
      missing_[static_cast<std::size_t>(i)] = 0;
    }
  };
  if (num_tasks <= 1) {
    work(0);
  } else {
    CallOn(work);
  }
}

/// The tasks of one of the above by a crew; or, without one, by this thread in their order.
template <typename Task>
void Share(Crew* crew, int num_tasks, const Task& task) {
  if (crew != nullptr) {
    crew->Do(num_tasks, task);
  } else {
    for (int i = 0; i < num_tasks; ++i) task(i, 0);
  }
}

template <typename Task>
void Share(Crew* crew, const Crew::Forest& forest, const Task& task) {
  if (crew != nullptr) {
    crew->Do(forest, task);
  } else {
    Share(nullptr, static_cast<int>(forest.parent.size()), task);
  }
}

template <typename Task>
void ShareDownwards(Crew* crew, const Crew::Forest& forest, const Task& task) {
  if (crew != nullptr) {
    crew->DoDownwards(forest, task);
  } else {
    for (const int i : forest.from_top) task(i, 0);
  }
}

}  // namespace vacuum_gripper_sim
