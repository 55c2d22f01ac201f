#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>
#include <vacuum_gripper_sim/ContactWrenches.h>
#include <vacuum_gripper_sim/SealState.h>
#include <vacuum_gripper_sim/VacuumState.h>

#include <cstdint>
#include <string>
#include <vector>

#include "moment.h"
#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/step_result.h"
#include "vacuum_gripper_sim/core/vacuum_sensor.h"

namespace vacuum_gripper_sim {

/// Of what is published every step.
inline constexpr std::uint32_t kQueueSize = 10;

std_msgs::Header MakeHeader(const ros::Time& stamp, const std::string& frame);

/// @param force [N] @param torque [N m] @param header Of the frame of their axes, at whose origin
/// they act.
geometry_msgs::WrenchStamped ToWrench(const Eigen::Vector3d& force, const Eigen::Vector3d& torque,
                                      const std_msgs::Header& header);

/// @param grip Of a gripper or one of its cups. @param setpoint [Pa] @param header Of its frame.
SealState ToSealState(const GripSummary& grip, double setpoint, const std_msgs::Header& header);

/// Absolute pressure in the cavity. @param ambient_pressure [Pa] @param header Of the grip's frame.
sensor_msgs::FluidPressure ToFluidPressure(const GripSummary& grip, double ambient_pressure,
                                           const std_msgs::Header& header);

/// @param ambient_pressure [Pa] @param header Stamped when it was sampled, of `cup_frame`.
VacuumState ToVacuumState(const VacuumReading& reading, double ambient_pressure,
                          const std_msgs::Header& header);

/// The classified points of the inner surface: x y z rgb gap zone. @param header Of `world_frame`.
sensor_msgs::PointCloud2 ToPointCloud(const StepResult& result, const CavitySurface& cavity,
                                      const std_msgs::Header& header);

/// @param X_PF Pose of the frame in its parent. @param header Of the parent.
geometry_msgs::TransformStamped ToTransform(const Eigen::Isometry3d& X_PF, const std::string& frame,
                                            const std_msgs::Header& header);

/// Poses of the free objects. @param objects Of the result. @param header Of `world_frame`.
std::vector<geometry_msgs::TransformStamped> ToTransforms(const StepResult& result,
                                                          const std::vector<ObjectLabel>& objects,
                                                          const std_msgs::Header& header);

/// What the cup does to the objects, each in its own frame. @param objects Of the result.
/// @param header Of `world_frame`.
ContactWrenches ToContactWrenches(const StepResult& result, const std::vector<ObjectLabel>& objects,
                                  const std_msgs::Header& header);

/// True when suction acts in a cavity that is airtight, or whose leak the pump keeps up with.
bool IsGrasping(const GripSummary& grip);

}  // namespace vacuum_gripper_sim
