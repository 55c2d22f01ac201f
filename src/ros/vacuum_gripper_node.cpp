#include "vacuum_gripper_node.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "loop_priority.h"
#include "messages.h"
#include "step_times.h"
#include "thread_time.h"
#include "vacuum_gripper_sim/core/gmsh_reader.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kMountIsBehind = 0.01;   // Distance to mount_frame that is worth a warning. [m]
constexpr std::size_t kOutboxSize = 100;  // Steps that may wait to be published.

}  // namespace

VacuumGripperNode::VacuumGripperNode(const ros::NodeHandle& private_nh)
    : nh_(private_nh),
      parameters_(ReadNodeParameters(private_nh)),
      mesh_(ReadGmsh(parameters_.cup.mesh_file)),
      simulator_(mesh_, parameters_.simulator, parameters_.X_WM),
      actuator_(parameters_.X_WM, parameters_.motion_limits, parameters_.simulator.time_step),
      world_(parameters_.scene_description, parameters_.world_frame, parameters_.surface_defaults),
      faults_(private_nh, parameters_.faults, FaultList(parameters_.simulator, world_.names())),
      margin_monitor_(private_nh, mesh_, parameters_.simulator, parameters_.cup_frame,
                      parameters_.margin_rate),
      schedule_(parameters_.simulator.time_step, ros::Time::isSimTime()),
      diagnostics_(parameters_.cup.name, parameters_.diagnostic_period,
                   parameters_.simulator.time_step, parameters_.simulator.contact.tolerance),
      result_publisher_(private_nh, parameters_, simulator_),
      outbox_([this](const Moment& moment) { result_publisher_.Publish(moment); }, kOutboxSize) {
  Subscribe();
  world_.Update(tf_buffer_, &simulator_);
  simulator_.Reset(parameters_.X_WM);  // now it sees the world
  Post(Occasion::kReset, ros::Time::now());
  const int num_cups = simulator_.cups().num_cups();
  ROS_INFO("%d cup%s %s: %d nodes, %d %s elements, %g Hz", num_cups, num_cups > 1 ? "s" : "",
           parameters_.cup.name.c_str(), simulator_.mesh().num_nodes(),
           simulator_.mesh().num_elements(), simulator_.mesh().quadratic() ? "quadratic" : "linear",
           parameters_.rate);
}

void VacuumGripperNode::Subscribe() {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  setpoint_subscriber_ = nh_.subscribe("pressure_setpoint", kQueueSize,
                                       &VacuumGripperNode::OnPressureSetpoint, this, hints);
  if (parameters_.actuator == ActuatorSource::kPoseCommand) {
    pose_subscriber_ =
        nh_.subscribe("pose_command", kQueueSize, &VacuumGripperNode::OnPoseCommand, this, hints);
  }
  on_server_ = nh_.advertiseService("on", &VacuumGripperNode::OnOn, this);
  off_server_ = nh_.advertiseService("off", &VacuumGripperNode::OnOff, this);
  grip_server_ = nh_.advertiseService("grip", &VacuumGripperNode::OnGrip, this);
  drop_server_ = nh_.advertiseService("drop", &VacuumGripperNode::OnDrop, this);
  reset_server_ = nh_.advertiseService("reset", &VacuumGripperNode::OnReset, this);
}

void VacuumGripperNode::Run() {
  LoopPriority priority(parameters_.realtime_priority, simulator_.HelperThreads());
  if (!priority.refusal().empty()) {
    ROS_WARN(
        "realtime_priority = %d is not granted (%s): scheduled normally. Allow it by 'rtprio' in "
        "/etc/security/limits.conf (see 'ulimit -r') or the capability CAP_SYS_NICE",
        parameters_.realtime_priority, priority.refusal().c_str());
  }
  diagnostics_.SetScheduling(SchedulingOfThisThread());
  outbox_.FollowPoster(priority.held());
  while (ros::ok()) {
    switch (schedule_.Poll(ros::Time::now())) {
      case StepSchedule::Event::kWait:
        break;
      case StepSchedule::Event::kJumpedBack:
        ROS_WARN("time jumped back: cup and free objects are reset");
        tf_buffer_.clear();
        mount_frame_seen_ = false;  // it begins anew where tf then says
        mount_frame_stamp_ = ros::Time();
        Reset();
        break;
      case StepSchedule::Event::kStep:
        Step(schedule_.StampOfStep(ros::Time::now()));
        break;
    }
    diagnostics_.Update();
    Wait(&priority);
  }
}

/// Until a step is due or messages have come, which it handles. The last busy_wait before a step it
/// stays awake, unless results still wait for the core that it would keep.
void VacuumGripperNode::Wait(LoopPriority* priority) {
  const auto time_left = [&] { return schedule_.TimeToWait(ros::Time::now()).toSec(); };
  const double busy_wait = ros::Time::isSimTime() ? 0.0 : parameters_.busy_wait;
  double left = time_left();
  const bool stays_awake = left > 0.0 && left <= busy_wait && outbox_.idle();
  double sleep = left > busy_wait ? left - busy_wait : left;
  if (stays_awake) sleep = 0.0;
  if (priority->OnSleep(sleep, ros::SteadyTime::now().toSec())) {
    diagnostics_.SetScheduling(SchedulingOfThisThread());
    outbox_.FollowPoster(false);
    ROS_WARN(
        "realtime_priority = %d is given up, scheduled normally from now on: for a second steps "
        "left the loop no time to sleep, and others would have been kept from the core",
        parameters_.realtime_priority);
  }
  ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(sleep));
  if (!stays_awake) return;
  while (left > 0.0 && left <= busy_wait) left = time_left();
  ros::getGlobalCallbackQueue()->callAvailable();
}

void VacuumGripperNode::Step(const ros::Time& stamp) {
  const ros::WallTime begin = ros::WallTime::now();
  const double computing_before = ThreadTime();
  world_.Update(tf_buffer_, &simulator_);
  if (parameters_.actuator == ActuatorSource::kTf) FollowMountFrame();
  faults_.Update(&simulator_);

  Command command;
  command.X_WM = actuator_.NextPose();
  command.pressure_setpoint = setpoint_;
  const StepResult& result = AdvanceSimulator(command);
  const bool undone = result.outcome != StepOutcome::kOk;
  actuator_.OnStep(result.X_WM, undone);
  if (undone && throttle_.Pass("undone")) {
    ROS_ERROR("step undone, last good state restored: %s", result.message.c_str());
  }
  const ros::WallTime before_posting = ros::WallTime::now();
  Post(Occasion::kStep, stamp);
  StepCost cost;
  cost.posting = (ros::WallTime::now() - before_posting).toSec();
  if (!undone) margin_monitor_.OnStep(stamp, simulator_);

  const bool met_deadline = schedule_.OnStepFinished(ros::Time::now());
  cost.wall = (ros::WallTime::now() - begin).toSec();
  cost.computing = ThreadTime() - computing_before;
  cost.publishing = outbox_.TakeDeliveryTime();
  diagnostics_.SetSkippedSteps(schedule_.skipped_steps());
  diagnostics_.OnStep(result, cost, met_deadline);
}

void VacuumGripperNode::Post(Occasion occasion, const ros::Time& stamp) {
  outbox_.Post([&](Moment* moment) {
    moment->occasion = occasion;
    moment->stamp = stamp;
    moment->result = simulator_.result();
    SetLabels(simulator_.objects(), &moment->objects);
    moment->sensor_stuck = faults_.sensor_stuck();
  });
}

const StepResult& VacuumGripperNode::AdvanceSimulator(const Command& command) {
  try {
    return simulator_.Step(command);
  } catch (const std::exception& error) {
    // Not a bad step but a broken state: start over rather than leave the robot without a gripper.
    ROS_ERROR("the simulation failed; cup and free objects are reset: %s", error.what());
    diagnostics_.OnFailure(error.what());
    Reset();
    return simulator_.result();
  }
}

// --- Commands ------------------------------------------------------------------------------------

void VacuumGripperNode::OnPressureSetpoint(const PressureSetpoint& message) {
  const double pressure = message.gauge_pressure;
  const double minimum = parameters_.simulator.regulator.min_pressure;
  std::string reason;
  if (!std::isfinite(pressure)) {
    reason = "not finite";
  } else if (pressure > 0.0) {
    reason = "positive (suction is negative gauge pressure)";
  } else if (pressure < minimum) {
    reason = "below regulator/min_pressure";
  } else {
    SetSetpoint(pressure);
    return;
  }
  if (throttle_.Pass("setpoint " + reason)) {
    ROS_WARN("%s refused: gauge_pressure = %g Pa is %s; allowed: %g .. 0 Pa; %g Pa stays",
             setpoint_subscriber_.getTopic().c_str(), pressure, reason.c_str(), minimum, setpoint_);
  }
}

void VacuumGripperNode::OnPoseCommand(const geometry_msgs::PoseStamped& message) {
  try {
    actuator_.SetTarget(ResolvePoseCommand(message, parameters_.world_frame, tf_buffer_));
  } catch (const std::invalid_argument& error) {
    const std::string reason = error.what();
    if (throttle_.Pass("pose " + reason.substr(0, reason.find('=')))) {
      ROS_WARN("%s refused: %s; the last good pose stays", pose_subscriber_.getTopic().c_str(),
               reason.c_str());
    }
  }
}

void VacuumGripperNode::FollowMountFrame() {
  const std::string& frame = parameters_.mount_frame;
  try {
    ros::Time stamp;
    const Eigen::Isometry3d X_WM = LookUpFrame(frame, parameters_.world_frame, tf_buffer_, &stamp);
    if (stamp.isZero() || stamp != mount_frame_stamp_) actuator_.SetTarget(X_WM);
    mount_frame_stamp_ = stamp;
    if (IsStale(stamp) && throttle_.Pass("mount stale")) {
      ROS_WARN("tf has not updated mount_frame '%s' for a while: the mount stays where it was last",
               frame.c_str());
    }
  } catch (const tf2::TransformException& error) {
    if (throttle_.Pass("mount")) {
      ROS_WARN("tf cannot place mount_frame '%s' in '%s' (%s): the mount stays where it is",
               frame.c_str(), parameters_.world_frame.c_str(), error.what());
    }
    return;
  }
  if (!mount_frame_seen_) {
    mount_frame_seen_ = true;  // It begins there, instead of flying in from the initial pose.
    actuator_.JumpToTarget();
    simulator_.Reset(actuator_.target());
  } else if (actuator_.IsBehind(kMountIsBehind) && throttle_.Pass("behind")) {
    ROS_WARN("the mount cannot keep up with mount_frame '%s': max_speed is %g m/s", frame.c_str(),
             parameters_.motion_limits.max_speed);
  }
}

bool VacuumGripperNode::OnOn(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  SetSetpoint(parameters_.simulator.regulator.default_pressure);
  return true;
}

bool VacuumGripperNode::OnOff(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  SetSetpoint(0.0);
  return true;
}

bool VacuumGripperNode::OnGrip(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const VacuumSourceType source = parameters_.simulator.vacuum.source;
  if (source == VacuumSourceType::kPassive || source == VacuumSourceType::kVented) {
    response.message = "refused: vacuum/source is passive or vented, there is nothing to switch on";
    response.success = false;
    return true;
  }
  SetSetpoint(parameters_.simulator.regulator.default_pressure);
  std::ostringstream message;
  message << "suction on, set-point " << setpoint_ << " Pa";
  response.message = message.str();
  response.success = true;
  return true;
}

bool VacuumGripperNode::OnDrop(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  SetSetpoint(0.0);
  const VacuumParameters& vacuum = parameters_.simulator.vacuum;
  const bool has_valve =
      vacuum.source == VacuumSourceType::kEjector || vacuum.source == VacuumSourceType::kPump;
  std::ostringstream message;
  message << "suction off";
  if (has_valve && vacuum.valve.blow_off_duration > 0.0) {
    message << ", blow-off for " << vacuum.valve.blow_off_duration << " s";
  }
  response.message = message.str();
  response.success = true;
  return true;
}

bool VacuumGripperNode::OnReset(std_srvs::Trigger::Request&,
                                std_srvs::Trigger::Response& response) {
  Reset();
  const Eigen::Vector3d p = actuator_.target().translation();
  std::ostringstream message;
  message << "rest shape at [" << p.x() << ", " << p.y() << ", " << p.z() << "] m in "
          << parameters_.world_frame << ", vented; free objects where they began";
  response.message = message.str();
  response.success = true;
  return true;
}

void VacuumGripperNode::SetSetpoint(double gauge_pressure) {
  setpoint_ = gauge_pressure;
  diagnostics_.OnSetpoint();
}

void VacuumGripperNode::Reset() {
  setpoint_ = 0.0;
  actuator_.JumpToTarget();
  world_.Reset(&simulator_);
  simulator_.Reset(actuator_.target());
  Post(Occasion::kReset, ros::Time::now());
}

}  // namespace vacuum_gripper_sim
