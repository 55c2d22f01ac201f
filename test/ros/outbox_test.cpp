#include "outbox.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <future>
#include <thread>
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

TEST(Outbox, PostingDoesNotWaitForADelivery) {
  std::promise<void> go;
  std::atomic<int> delivered{0};
  {
    Outbox<int> outbox(
        [&, started = go.get_future().share()](int) {
          started.wait();
          ++delivered;
        },
        3);
    for (int i = 0; i < 3; ++i) outbox.Post([&](int* item) { *item = i; });
    EXPECT_EQ(delivered, 0);
    go.set_value();
  }
  EXPECT_EQ(delivered, 3);  // what waited was delivered
}

TEST(Outbox, PostingToAFullOneWaitsForRoom) {
  std::promise<void> go;
  std::atomic<int> delivered{0};
  Outbox<int> outbox(
      [&, started = go.get_future().share()](int) {
        started.wait();
        ++delivered;
      },
      1);
  std::thread poster([&] {
    for (int i = 0; i < 3; ++i) outbox.Post([&](int* item) { *item = i; });
    EXPECT_GE(delivered, 2);  // there was room for the last one
  });
  go.set_value();
  poster.join();
}

TEST(Outbox, ItemsKeepTheirMemory) {
  Outbox<std::vector<int>> outbox([](const std::vector<int>&) {}, 1);
  outbox.Post([](std::vector<int>* item) { item->assign(2, 0); });
  outbox.Post([](std::vector<int>* item) { EXPECT_GE(item->capacity(), 2U); });
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
