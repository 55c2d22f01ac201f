#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <vacuum_gripper_sim/PressureSetpoint.h>

#include "actuator.h"
#include "diagnostics.h"
#include "fault_server.h"
#include "loop_priority.h"
#include "margin_monitor.h"
#include "moment.h"
#include "outbox.h"
#include "parameters.h"
#include "result_publisher.h"
#include "step_schedule.h"
#include "throttle.h"
#include "vacuum_gripper_sim/core/simulator.h"
#include "world.h"

namespace vacuum_gripper_sim {

/** Translates between ROS and the Simulator; holds no physics.

 One thread steps and serves callbacks, so commands act between two steps and never during one; tf
 listens and results are published on threads of their own. */
class VacuumGripperNode {
 public:
  /// @throws std::invalid_argument naming the parameter that is not set, mistyped or out of range.
  explicit VacuumGripperNode(const ros::NodeHandle& private_nh);

  /// Steps at `rate` Hz of ROS time until shutdown. A step is always h = 1 / rate long: when it is
  /// late the simulation falls behind, h does not grow.
  void Run();

 private:
  void Subscribe();

  void OnPressureSetpoint(const PressureSetpoint& message);
  void OnPoseCommand(const geometry_msgs::PoseStamped& message);
  bool OnOn(std_srvs::Empty::Request&, std_srvs::Empty::Response&);
  bool OnOff(std_srvs::Empty::Request&, std_srvs::Empty::Response&);
  bool OnGrip(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  bool OnDrop(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  bool OnReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);

  void SetSetpoint(double gauge_pressure);
  void FollowMountFrame();
  void Reset();  // The cup and the free objects.
  void Wait(LoopPriority* priority);
  void Step(const ros::Time& stamp);
  const StepResult& AdvanceSimulator(const Command& command);
  void Post(Occasion occasion, const ros::Time& stamp);  // The simulator's state, to be published.

  ros::NodeHandle nh_;
  NodeParameters parameters_;
  TetMesh mesh_;  // of a single cup
  Simulator simulator_;
  Actuator actuator_;
  World world_;
  FaultServer faults_;
  MarginMonitor margin_monitor_;
  StepSchedule schedule_;
  Diagnostics diagnostics_;
  Throttle throttle_;

  double setpoint_{0.0};          // Last accepted. [Pa] gauge
  bool mount_frame_seen_{false};  // With actuator tf.
  ros::Time mount_frame_stamp_;   // Of its pose last taken; zero: static, or none yet.

  tf2_ros::Buffer tf_buffer_;
  tf2_ros::TransformListener tf_listener_{tf_buffer_};
  ros::Subscriber setpoint_subscriber_, pose_subscriber_;
  ros::ServiceServer on_server_, off_server_, grip_server_, drop_server_, reset_server_;

  ResultPublisher result_publisher_;
  Outbox<Moment> outbox_;  // last: publishes on its thread with what is above
};

}  // namespace vacuum_gripper_sim
