#include "core_follower.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

/// Where a thread may run.
std::vector<int> CoresOf(pthread_t thread) {
  cpu_set_t set;
  EXPECT_EQ(pthread_getaffinity_np(thread, sizeof(set), &set), 0);
  std::vector<int> cores;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &set)) cores.push_back(core);
  }
  return cores;
}

void KeepOn(int core) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(core), &set);
  ASSERT_EQ(pthread_setaffinity_np(pthread_self(), sizeof(set), &set), 0);
}

TEST(CoreFollower, GoesFromCoreToCoreAndBackToAll) {
  std::promise<void> end;
  std::thread thread([&] { end.get_future().wait(); });
  const std::vector<int> all = CoresOf(thread.native_handle());
  std::thread([&] {  // which is then kept on a core, as the test's own thread must not be
    CoreFollower follower(thread.native_handle());
    for (const int core : all) {
      KeepOn(core);
      follower.Follow();
      EXPECT_EQ(CoresOf(thread.native_handle()), std::vector<int>{core});
    }
    follower.LetGo();
    EXPECT_EQ(CoresOf(thread.native_handle()), all);
    follower.Follow();
    EXPECT_EQ(CoresOf(thread.native_handle()), std::vector<int>{all.back()});
  })
      .join();
  end.set_value();
  thread.join();
}

}  // namespace
}  // namespace vacuum_gripper_sim
