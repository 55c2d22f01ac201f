#include "margin_monitor.h"

#include <vacuum_gripper_sim/HoldingMargin.h>

#include <cstdint>
#include <exception>
#include <utility>

namespace vacuum_gripper_sim {

MarginMonitor::MarginMonitor(ros::NodeHandle private_nh, TetMesh mesh,
                             const SimulatorParameters& parameters, std::string frame, double rate)
    : publisher_(private_nh.advertise<HoldingMargin>("holding_margin", 2)),
      frame_(std::move(frame)),
      period_(1.0 / rate),
      mesh_(std::move(mesh)),
      parameters_(parameters),
      thread_([this] { Work(); }) {}

MarginMonitor::~MarginMonitor() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void MarginMonitor::OnStep(const ros::Time& stamp, const Simulator& simulator) {
  const ros::WallTime now = ros::WallTime::now();
  if (now < next_) return;
  next_ = now + period_;
  // Not in every step: it takes a lock that threads hold which publish.
  if (publisher_.getNumSubscribers() == 0) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (moment_) return;
    moment_ = Moment{stamp, simulator.Save()};
  }
  changed_.notify_one();
}

void MarginMonitor::Work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || moment_; });
    if (stopping_) return;
    const Moment moment = *moment_;
    lock.unlock();
    Measure(moment);
    lock.lock();
    moment_.reset();
  }
}

void MarginMonitor::Measure(const Moment& moment) {
  try {
    if (!trial_) trial_.emplace(mesh_, parameters_);
    const HoldingReserve reserve = trial_->Measure(moment.snapshot);
    HoldingMargin message;
    message.header.stamp = moment.stamp;
    message.header.frame_id = frame_;
    message.holds = static_cast<std::uint8_t>(reserve.holds);
    message.normal_force = reserve.normal_force;
    message.shear_force = reserve.shear_force;
    message.tilting_moment = reserve.tilting_moment;
    publisher_.publish(message);
  } catch (const std::exception& error) {
    ROS_ERROR_THROTTLE(10.0, "holding_margin: the trial failed: %s", error.what());
  }
}

}  // namespace vacuum_gripper_sim
