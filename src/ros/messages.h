#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>
#include <vacuum_gripper_sim/ContactWrenches.h>
#include <vacuum_gripper_sim/SealState.h>

#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/rigid_object.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/// Force and torque of the cup on its mount, at the mount's origin. @param header Of `cup_frame`.
geometry_msgs::WrenchStamped ToWrench(const StepResult& result, const std_msgs::Header& header);

/// @param header Of `cup_frame`.
SealState ToSealState(const StepResult& result, const std_msgs::Header& header);

/// Absolute pressure in the cavity. @param ambient_pressure [Pa] @param header Of `cup_frame`.
sensor_msgs::FluidPressure ToFluidPressure(const StepResult& result, double ambient_pressure,
                                           const std_msgs::Header& header);

/// The classified points of the inner surface: x y z rgb gap zone. @param header Of `world_frame`.
sensor_msgs::PointCloud2 ToPointCloud(const StepResult& result, const CavitySurface& cavity,
                                      const std_msgs::Header& header);

/// Pose of `cup_frame`. @param header Of `world_frame`.
geometry_msgs::TransformStamped ToTransform(const StepResult& result, const std::string& cup_frame,
                                            const std_msgs::Header& header);

/// Poses of the free objects. @param objects Of the result. @param header Of `world_frame`.
std::vector<geometry_msgs::TransformStamped> ToTransforms(const StepResult& result,
                                                          const std::vector<RigidObject>& objects,
                                                          const std_msgs::Header& header);

/// What the cup does to the objects, each in its own frame. @param objects Of the result.
/// @param header Of `world_frame`.
ContactWrenches ToContactWrenches(const StepResult& result, const std::vector<RigidObject>& objects,
                                  const std_msgs::Header& header);

/// True when the cavity is airtight and suction acts in it.
bool IsGrasping(const StepResult& result);

}  // namespace vacuum_gripper_sim
