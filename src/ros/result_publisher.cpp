#include "result_publisher.h"

#include <ros/console.h>
#include <std_msgs/Bool.h>

#include <cstddef>

#include "messages.h"

namespace vacuum_gripper_sim {

ResultPublisher::ResultPublisher(const ros::NodeHandle& private_nh,
                                 const NodeParameters& parameters, const Simulator& simulator)
    : nh_(private_nh),
      world_frame_(parameters.world_frame),
      cup_frame_(parameters.cup_frame),
      ambient_pressure_(parameters.simulator.vacuum.ambient_pressure),
      broadcasts_mount_(parameters.actuator == ActuatorSource::kPoseCommand),
      display_period_(1.0 / parameters.display_rate),
      cavity_(&simulator.cavity()),
      painter_(simulator.mesh(), simulator.cavity()),
      vacuum_state_(private_nh, parameters.sensor, ambient_pressure_, cup_frame_) {
  constexpr bool kLatched = true;
  wrench_publisher_ = nh_.advertise<geometry_msgs::WrenchStamped>("wrench", kQueueSize);
  contact_wrenches_publisher_ = nh_.advertise<ContactWrenches>("contact_wrenches", kQueueSize);
  seal_publisher_ = nh_.advertise<SealState>("seal_state", kQueueSize, kLatched);
  pressure_publisher_ = nh_.advertise<sensor_msgs::FluidPressure>("pressure", kQueueSize);
  points_publisher_ = nh_.advertise<sensor_msgs::PointCloud2>("surface_points", 2);
  markers_publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("markers", 2);
  grasping_publisher_ = nh_.advertise<std_msgs::Bool>("grasping", kQueueSize, kLatched);
  AdvertiseCups(parameters.simulator.cups);
}

void ResultPublisher::AdvertiseCups(const std::vector<CupMount>& cups) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  const std_msgs::Header header = MakeHeader(ros::Time::now(), cup_frame_);
  for (const CupMount& cup : cups) {
    if (cup.name.empty()) return;  // the only one, without a list
    cup_publishers_.emplace_back(nh_, cup, cup_frame_);
    transforms.push_back(ToTransform(cup.X_MC, cup_publishers_.back().frame(), header));
  }
  static_tf_broadcaster_.sendTransform(transforms);
}

void ResultPublisher::Publish(const Moment& moment) {
  if (moment.occasion == Occasion::kStep) {
    PublishStep(moment);
  } else {
    vacuum_state_.Reset();
  }
  PublishState(moment);
  if (moment.occasion == Occasion::kStep) PublishDisplay(moment);
}

void ResultPublisher::PublishStep(const Moment& moment) {
  const StepResult& result = moment.result;
  const std_msgs::Header cup_header = MakeHeader(moment.stamp, cup_frame_);
  const std_msgs::Header world_header = MakeHeader(moment.stamp, world_frame_);
  std::vector<geometry_msgs::TransformStamped> transforms =
      ToTransforms(result, moment.objects, world_header);
  if (broadcasts_mount_) {
    transforms.push_back(ToTransform(result.X_WM, cup_frame_, world_header));
  }
  if (!transforms.empty()) tf_broadcaster_.sendTransform(transforms);
  contact_wrenches_publisher_.publish(ToContactWrenches(result, moment.objects, world_header));
  wrench_publisher_.publish(ToWrench(result.force_M, result.torque_M, cup_header));
  pressure_publisher_.publish(ToFluidPressure(result, ambient_pressure_, cup_header));
  for (std::size_t i = 0; i < cup_publishers_.size(); ++i) {
    cup_publishers_[i].PublishForces(moment.stamp, result.cups[i], ambient_pressure_);
  }
  vacuum_state_.OnStep(moment.stamp, result, moment.sensor_stuck);
}

void ResultPublisher::PublishState(const Moment& moment) {
  const StepResult& result = moment.result;
  seal_publisher_.publish(
      ToSealState(result, result.setpoint, MakeHeader(moment.stamp, cup_frame_)));
  for (std::size_t i = 0; i < cup_publishers_.size(); ++i) {
    cup_publishers_[i].PublishState(moment.stamp, result.cups[i], result.setpoint);
  }
  const bool grasping = IsGrasping(result);
  if (grasping != grasping_ || !grasping_published_) {
    std_msgs::Bool message;
    message.data = grasping;
    grasping_publisher_.publish(message);
    grasping_ = grasping;
    grasping_published_ = true;
  }
  if (result.status != last_status_) {
    ROS_INFO("seal: %s (%.0f Pa)", NameOf(result.status), result.gauge_pressure);
    last_status_ = result.status;
  }
}

/// What is large: at the display's rate and only to those who listen.
void ResultPublisher::PublishDisplay(const Moment& moment) {
  // Paced by wall time: it is people who look.
  const ros::WallTime now = ros::WallTime::now();
  if (now < next_display_) return;
  const bool wants_points = points_publisher_.getNumSubscribers() > 0;
  const bool wants_markers = markers_publisher_.getNumSubscribers() > 0;
  if (!wants_points && !wants_markers) return;
  next_display_ = now + display_period_;
  const std_msgs::Header header = MakeHeader(moment.stamp, world_frame_);
  if (wants_points) points_publisher_.publish(ToPointCloud(moment.result, *cavity_, header));
  if (wants_markers) markers_publisher_.publish(painter_.Paint(moment.result, header));
}

}  // namespace vacuum_gripper_sim
