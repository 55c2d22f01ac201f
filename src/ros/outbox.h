#pragma once

#include <semaphore.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core_follower.h"
#include "thread_time.h"

namespace vacuum_gripper_sim {

/** Delivers items on a thread of its own, in the order they were posted.

 Posting takes as long as filling an item in: there is no lock for which a thread of high priority
 would wait for the deliveries of one of low priority, unless the outbox is full. Items are used
 again, so that posting allocates no memory once they are large enough.

 One thread posts, and calls everything else. */
template <typename Item>
class Outbox {
 public:
  /// @param deliver Called on the outbox's thread; must not throw. @param capacity Items posted and
  /// not yet delivered. > 0
  Outbox(std::function<void(const Item&)> deliver, std::size_t capacity)
      : deliver_(std::move(deliver)), items_(capacity) {
    sem_init(&room_, 0, static_cast<unsigned>(capacity));
    sem_init(&posted_, 0, 0);
    thread_ = std::thread([this] { Work(); });
    follower_.emplace(thread_.native_handle());
  }
  /// Delivers what still waits.
  ~Outbox() {
    stopping_ = true;
    sem_post(&posted_);
    thread_.join();
    sem_destroy(&posted_);
    sem_destroy(&room_);
  }
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// Whether items are delivered on the core of the thread that posts, which then spends less on
  /// waking up the outbox's. For one that goes before it there and rests between two items: see
  /// CoreFollower. Where three items wait, deliveries go on on any core for the next
  /// kItemsElsewhere.
  void FollowPoster(bool follows) {
    follows_ = follows;
    if (!follows) follower_->LetGo();
  }
  static constexpr std::size_t kItemsElsewhere = 1000;

  /// Waits while the outbox is full. @param fill void(Item*), sets all of an item, new or used.
  template <typename Fill>
  void Post(Fill fill) {
    Wait(&room_);
    if (follows_) ChooseCore();
    fill(&items_[num_posted_ % items_.size()]);
    ++num_posted_;
    sem_post(&posted_);
  }

  /// Whether all is delivered.
  bool idle() const { return num_delivered_ == num_posted_; }
  /// What delivering took since it was asked for last, of a core's time. [s]
  double TakeDeliveryTime() { return 1e-9 * static_cast<double>(delivery_time_.exchange(0)); }

 private:
  static constexpr std::size_t kBehind = 3;  // Items that wait where deliveries have no time.

  static void Wait(sem_t* semaphore) {
    while (sem_wait(semaphore) != 0) {  // a signal came between
    }
  }

  void ChooseCore() {
    if (num_posted_ - num_delivered_ >= kBehind) {
      follower_->LetGo();
      follow_from_ = num_posted_ + kItemsElsewhere;
    } else if (num_posted_ >= follow_from_) {
      follower_->Follow();
    }
  }

  void Work() {
    while (true) {
      Wait(&posted_);
      if (num_delivered_ == num_posted_ && stopping_) return;
      const double begin = ThreadTime();
      deliver_(items_[num_delivered_ % items_.size()]);
      ++num_delivered_;
      sem_post(&room_);
      delivery_time_ += static_cast<std::int64_t>(1e9 * (ThreadTime() - begin));
    }
  }

  std::function<void(const Item&)> deliver_;
  std::vector<Item> items_;  // a ring
  sem_t room_{}, posted_{};
  std::atomic<std::size_t> num_posted_{0}, num_delivered_{0};
  std::atomic<std::int64_t> delivery_time_{0};  // [ns]
  std::atomic<bool> stopping_{false};
  bool follows_{false};
  std::size_t follow_from_{0};  // Items posted.
  std::thread thread_;
  std::optional<CoreFollower> follower_;  // of the thread
};

}  // namespace vacuum_gripper_sim
