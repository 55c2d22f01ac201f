#pragma once

#include <ros/time.h>

#include <map>
#include <string>

namespace vacuum_gripper_sim {

/** Lets a message through once a second for each key.
 In wall time, unlike rosconsole's throttling: a paused /clock must not swallow warnings. */
class Throttle {
 public:
  bool Pass(const std::string& key) {
    const ros::WallTime now = ros::WallTime::now();
    const auto [entry, is_new] = last_.emplace(key, now);
    const double age = (now - entry->second).toSec();
    if (!is_new && age >= 0.0 && age < 1.0) return false;
    entry->second = now;
    return true;
  }

 private:
  std::map<std::string, ros::WallTime> last_;
};

}  // namespace vacuum_gripper_sim
