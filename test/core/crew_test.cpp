#include "vacuum_gripper_sim/core/crew.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

TEST(Crew, DoesEveryTaskOnce) {
  for (const int size : {1, 2, 5}) {
    Crew crew(size);
    EXPECT_EQ(crew.size(), size);
    for (const int num_tasks : {0, 1, 3, 1000}) {
      std::vector<std::atomic<int>> times(static_cast<std::size_t>(num_tasks));
      std::atomic<bool> known{true};
      crew.Do(num_tasks, [&](int task, int member) {
        ++times[static_cast<std::size_t>(task)];
        if (member < 0 || member >= size) known = false;
      });
      EXPECT_TRUE(known);
      for (const auto& time : times) EXPECT_EQ(time, 1);
    }
  }
}

// Each of as many tasks as members waits for the others to have begun.
TEST(Crew, MembersWorkAtTheSameTime) {
  constexpr int kSize = 3;
  Crew crew(kSize);
  std::mutex mutex;
  std::condition_variable begun;
  std::set<int> members;
  std::set<std::thread::native_handle_type> threads;
  crew.Do(kSize, [&](int /*task*/, int member) {
    std::unique_lock<std::mutex> lock(mutex);
    members.insert(member);
    threads.insert(pthread_self());
    begun.notify_all();
    begun.wait(lock, [&] { return members.size() == kSize; });
  });
  EXPECT_EQ(members, (std::set<int>{0, 1, 2}));
  EXPECT_EQ(threads.size(), 3U);
  std::set<std::thread::native_handle_type> known{pthread_self()};
  for (const auto helper : crew.HelperThreads()) known.insert(helper);
  EXPECT_EQ(threads, known);
}

/// A complete binary tree of tasks, children first; beside it a second, single one.
Crew::Forest BinaryTree(int num_levels) {
  Crew::Forest forest;
  const int size = (1 << num_levels) - 1;
  for (int i = 0; i < size; ++i) {
    const int heap = size - 1 - i;  // the root is 0
    forest.parent.push_back(heap == 0 ? -1 : size - 1 - (heap - 1) / 2);
    forest.num_children.push_back(2 * heap + 1 < size ? 2 : 0);
    if (forest.num_children.back() == 0) forest.leaves.push_back(i);
  }
  forest.parent.push_back(-1);
  forest.num_children.push_back(0);
  forest.leaves.push_back(size);
  for (int i = size; i >= 0; --i) forest.from_top.push_back(i);
  return forest;
}

TEST(Crew, DoesChildrenBeforeTheirParent) {
  const Crew::Forest forest = BinaryTree(8);
  for (const int size : {1, 2, 4}) {
    Crew crew(size);
    for (int round = 0; round < 20; ++round) {
      std::vector<std::atomic<int>> children_done(forest.parent.size());
      std::atomic<int> done{0};
      std::atomic<bool> in_order{true};
      crew.Do(forest, [&](int task, int /*member*/) {
        const auto i = static_cast<std::size_t>(task);
        if (children_done[i] != forest.num_children[i]) in_order = false;
        if (forest.parent[i] >= 0) ++children_done[static_cast<std::size_t>(forest.parent[i])];
        ++done;
      });
      EXPECT_TRUE(in_order);
      EXPECT_EQ(done, static_cast<int>(forest.parent.size()));
    }
  }
}

// What one thread wrote for a task, the one that does its parent reads.
TEST(Crew, ParentsSeeWhatTheirChildrenWrote) {
  const Crew::Forest forest = BinaryTree(10);
  Crew crew(3);
  for (int round = 0; round < 50; ++round) {
    std::vector<long> below(forest.parent.size(), 0);  // written without any lock
    std::vector<std::array<long, 2>> from_children(forest.parent.size(), {0, 0});
    crew.Do(forest, [&](int task, int /*member*/) {
      const auto i = static_cast<std::size_t>(task);
      below[i] = 1 + from_children[i][0] + from_children[i][1];
      if (forest.parent[i] < 0) return;
      from_children[static_cast<std::size_t>(forest.parent[i])][i % 2] = below[i];
    });
    EXPECT_EQ(below[forest.parent.size() - 2], (1 << 10) - 1);
  }
}

// Sums of paths from the root; each task reads what its parent wrote, without any lock.
TEST(Crew, ChildrenSeeWhatTheirParentWrote) {
  const Crew::Forest forest = BinaryTree(10);
  for (const int size : {1, 2, 4}) {
    Crew crew(size);
    for (int round = 0; round < 20; ++round) {
      std::vector<long> depth(forest.parent.size(), -1);
      std::atomic<int> done{0};
      crew.DoDownwards(forest, [&](int task, int /*member*/) {
        const auto i = static_cast<std::size_t>(task);
        const int parent = forest.parent[i];
        depth[i] = parent < 0 ? 0 : depth[static_cast<std::size_t>(parent)] + 1;
        ++done;
      });
      EXPECT_EQ(done, static_cast<int>(forest.parent.size()));
      EXPECT_EQ(std::accumulate(depth.begin(), depth.end(), 0L), (10 - 2) * (1L << 10) + 2);
    }
  }
}

// A task that takes long keeps only those below it waiting, and whoever waits gets on in the end.
TEST(Crew, WaitsForAParentThatTakesLong) {
  const Crew::Forest forest = BinaryTree(3);
  Crew crew(3);
  std::atomic<bool> root_done{false};
  std::atomic<bool> in_order{true};
  crew.DoDownwards(forest, [&](int task, int /*member*/) {
    const auto i = static_cast<std::size_t>(task);
    if (i + 2 == forest.parent.size()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      root_done = true;
    } else if (forest.parent[i] >= 0 && !root_done) {
      in_order = false;
    }
  });
  EXPECT_TRUE(in_order);
}

TEST(Crew, SharingWithoutACrewGoesInOrder) {
  std::vector<int> tasks;
  Share(nullptr, 4, [&](int task, int member) { tasks.push_back(task + 10 * member); });
  EXPECT_EQ(tasks, (std::vector<int>{0, 1, 2, 3}));
  const Crew::Forest forest = BinaryTree(3);
  tasks.clear();
  Share(nullptr, forest, [&](int task, int /*member*/) { tasks.push_back(task); });
  std::vector<int> all(forest.parent.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(tasks, all);
  tasks.clear();
  ShareDownwards(nullptr, forest, [&](int task, int /*member*/) { tasks.push_back(task); });
  EXPECT_EQ(tasks, forest.from_top);
}

}  // namespace
}  // namespace vacuum_gripper_sim
