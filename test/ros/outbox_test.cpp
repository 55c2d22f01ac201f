#include "outbox.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <future>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

TEST(Outbox, DeliversEverythingInOrderOnAnotherThread) {
  std::vector<int> delivered;
  std::thread::id thread;
  {
    Outbox<int> outbox(
        [&](int item) {
          delivered.push_back(item);
          thread = std::this_thread::get_id();
        },
        3);
    for (int i = 0; i < 1000; ++i) outbox.Post([&](int* item) { *item = i; });
  }
  ASSERT_EQ(delivered.size(), 1000U);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(delivered[static_cast<std::size_t>(i)], i);
  EXPECT_NE(thread, std::this_thread::get_id());
}

/// Delivers nothing until it is let go.
class HeldOutbox {
 public:
  explicit HeldOutbox(std::size_t capacity)
      : outbox_(
            std::in_place,
            [this, let_go = let_go_.get_future().share()](int) {
              let_go.wait();
              ++delivered_;
            },
            capacity) {}

  void Post(int count) {
    for (int i = 0; i < count; ++i) outbox_->Post([&](int* item) { *item = i; });
  }
  void LetGo() { let_go_.set_value(); }
  void End() { outbox_.reset(); }
  int delivered() const { return delivered_; }

 private:
  std::promise<void> let_go_;
  std::atomic<int> delivered_{0};
  std::optional<Outbox<int>> outbox_;
};

TEST(Outbox, PostingDoesNotWaitForADelivery) {
  HeldOutbox outbox(3);
  outbox.Post(3);
  EXPECT_EQ(outbox.delivered(), 0);
  outbox.LetGo();
  outbox.End();
  EXPECT_EQ(outbox.delivered(), 3);  // what waited was delivered
}

TEST(Outbox, PostingToAFullOneWaitsForRoom) {
  HeldOutbox outbox(1);
  std::thread poster([&] {
    outbox.Post(3);
    EXPECT_GE(outbox.delivered(), 2);  // there was room for the last one
  });
  outbox.LetGo();
  poster.join();
}

TEST(Outbox, ItemsKeepTheirMemory) {
  Outbox<std::vector<int>> outbox([](const std::vector<int>&) {}, 1);
  outbox.Post([](std::vector<int>* item) { item->assign(2, 0); });
  outbox.Post([](std::vector<int>* item) { EXPECT_GE(item->capacity(), 2U); });
}

/// How many cores the calling thread may run on.
int NumCores() {
  cpu_set_t cores;
  EXPECT_EQ(sched_getaffinity(0, sizeof(cores), &cores), 0);
  return CPU_COUNT(&cores);
}

TEST(Outbox, DeliversOnThePostersCoreIfAskedTo) {
  std::atomic<int> num_cores{0};
  Outbox<int> outbox([&](int) { num_cores = NumCores(); }, 1);
  // There is room for the second one when the first has been delivered.
  const auto deliver = [&] {
    for (int i = 0; i < 2; ++i) outbox.Post([&](int* item) { *item = i; });
    return num_cores.load();
  };
  EXPECT_EQ(deliver(), NumCores());
  outbox.FollowPoster(true);
  EXPECT_EQ(deliver(), 1);
  outbox.FollowPoster(false);
  EXPECT_EQ(deliver(), NumCores());
}

TEST(Outbox, LeavesThePostersCoreWhileDeliveriesAreBehind) {
  std::promise<void> let_go;
  std::vector<int> num_cores;
  {
    Outbox<int> outbox(
        [&, may_go = let_go.get_future().share()](int) {
          may_go.wait();
          num_cores.push_back(NumCores());
        },
        10);
    outbox.FollowPoster(true);
    for (int i = 0; i < 5; ++i) outbox.Post([&](int* item) { *item = i; });
    let_go.set_value();
  }
  EXPECT_EQ(num_cores, std::vector<int>(5, NumCores()));
}

TEST(Outbox, TellsWhatDeliveringTook) {
  Outbox<int> outbox(
      [](int) {
        const auto begin = std::chrono::steady_clock::now();
        while (std::chrono::steady_clock::now() == begin) {
        }
      },
      1);
  // There is room for the third one when the second, and so the first, has been accounted for.
  for (int i = 0; i < 3; ++i) outbox.Post([&](int* item) { *item = i; });
  EXPECT_GT(outbox.TakeDeliveryTime(), 0.0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
