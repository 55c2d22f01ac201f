#pragma once

#include <ros/ros.h>

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "vacuum_gripper_sim/core/holding_trial.h"

namespace vacuum_gripper_sim {

/// Publishes `~holding_margin` from a thread of its own: trials take as long as hundreds of steps.
class MarginMonitor {
 public:
  /// @param private_nh Publishes below it. @param mesh,parameters See HoldingTrial.
  /// @param frame Of the messages. @param rate At most so many a second. [Hz]
  MarginMonitor(ros::NodeHandle private_nh, TetMesh mesh, const SimulatorParameters& parameters,
                std::string frame, double rate);
  ~MarginMonitor();
  MarginMonitor(const MarginMonitor&) = delete;
  MarginMonitor& operator=(const MarginMonitor&) = delete;

  /// After a step: begins a trial of this moment if one is due, wanted, and the last is done.
  void OnStep(const ros::Time& stamp, const Simulator& simulator);

 private:
  struct Moment {
    ros::Time stamp;
    Snapshot snapshot;
  };
  void Work();
  void Measure(const Moment& moment);

  ros::Publisher publisher_;
  std::string frame_;
  ros::WallDuration period_;
  ros::WallTime next_;
  TetMesh mesh_;
  SimulatorParameters parameters_;
  std::optional<HoldingTrial> trial_;  // of the thread, from the first one on

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Moment> moment_;  // to try, or at trial
  bool stopping_{false};
  std::thread thread_;  // last: begins when all else is there
};

}  // namespace vacuum_gripper_sim
