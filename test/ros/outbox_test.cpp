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

TEST(Outbox, LeavesThePostersCoreForAWhileWhenDeliveriesFallBehind) {
  std::promise<void> let_go;
  std::vector<int> num_cores;
  std::atomic<std::size_t> num_delivered{0};
  std::size_t num_posted = 0;
  {
    Outbox<int> outbox(
        [&, may_go = let_go.get_future().share()](int) {
          may_go.wait();
          num_cores.push_back(NumCores());
          ++num_delivered;
        },
        10);
    const auto post = [&](std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) outbox.Post([](int* item) { *item = 0; });
      num_posted += count;
    };
    const auto catch_up = [&] {
      while (num_delivered < num_posted) std::this_thread::yield();
    };
    outbox.FollowPoster(true);
    post(5);  // the fourth one finds three that wait
    let_go.set_value();
    catch_up();
    for (std::size_t i = 0; i < Outbox<int>::kItemsElsewhere; ++i) {
      post(1);
      catch_up();
    }
  }
  // The fifth one was the last to find them: so many on any core, and the next one beside the
  // poster.
  const std::size_t num_elsewhere = 4 + Outbox<int>::kItemsElsewhere;
  ASSERT_EQ(num_cores.size(), num_elsewhere + 1);
  EXPECT_EQ(std::vector<int>(num_cores.begin(), num_cores.end() - 1),
            std::vector<int>(num_elsewhere, NumCores()));
  EXPECT_EQ(num_cores.back(), 1);
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
