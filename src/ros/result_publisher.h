#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <string>
#include <vector>

#include "cup_publisher.h"
#include "markers.h"
#include "moment.h"
#include "parameters.h"
#include "vacuum_gripper_sim/core/simulator.h"
#include "vacuum_state_publisher.h"

namespace vacuum_gripper_sim {

/// Publishes what the simulation does, on topics and tf, for one thread to call.
class ResultPublisher {
 public:
  /// @param private_nh Publishes below it. @param simulator Its mesh and cavity must outlive this.
  ResultPublisher(const ros::NodeHandle& private_nh, const NodeParameters& parameters,
                  const Simulator& simulator);

  void Publish(const Moment& moment);

 private:
  void AdvertiseCups(const std::vector<CupMount>& cups);
  void PublishStep(const Moment& moment);
  void PublishState(const Moment& moment);  // What is latched.
  void PublishDisplay(const Moment& moment);

  ros::NodeHandle nh_;
  std::string world_frame_, cup_frame_;
  double ambient_pressure_;  // [Pa]
  bool broadcasts_mount_;
  ros::WallDuration display_period_;
  ros::WallTime next_display_;
  const CavitySurface* cavity_;
  MarkerPainter painter_;
  VacuumStatePublisher vacuum_state_;
  bool grasping_{false};
  bool grasping_published_{false};
  SealStatus last_status_{SealStatus::kOpen};

  tf2_ros::TransformBroadcaster tf_broadcaster_;
  tf2_ros::StaticTransformBroadcaster static_tf_broadcaster_;
  ros::Publisher wrench_publisher_, contact_wrenches_publisher_, seal_publisher_,
      pressure_publisher_, points_publisher_, markers_publisher_, grasping_publisher_;
  std::vector<CupPublisher> cup_publishers_;  // Of cups with names, all or none.
};

}  // namespace vacuum_gripper_sim
