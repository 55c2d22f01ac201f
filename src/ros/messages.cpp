#include "messages.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "zone_colors.h"

namespace vacuum_gripper_sim {
namespace {

static_assert(SealState::OPEN == static_cast<int>(SealStatus::kOpen), "message and core disagree");
static_assert(SealState::SEALED == static_cast<int>(SealStatus::kSealed), "likewise");
static_assert(SealState::REGULATING == static_cast<int>(SealStatus::kRegulating), "likewise");
static_assert(SealState::LOST == static_cast<int>(SealStatus::kLost), "likewise");

geometry_msgs::Vector3 ToVector3(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

geometry_msgs::TransformStamped ToTransformStamped(const Eigen::Isometry3d& X_WF,
                                                   const std::string& frame,
                                                   const std_msgs::Header& header) {
  geometry_msgs::TransformStamped message;
  message.header = header;
  message.child_frame_id = frame;
  message.transform.translation = ToVector3(X_WF.translation());
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(X_WF.linear()).normalized();
  message.transform.rotation.x = rotation.x();
  message.transform.rotation.y = rotation.y();
  message.transform.rotation.z = rotation.z();
  message.transform.rotation.w = rotation.w();
  return message;
}

}  // namespace

geometry_msgs::WrenchStamped ToWrench(const StepResult& result, const std_msgs::Header& header) {
  geometry_msgs::WrenchStamped message;
  message.header = header;
  message.wrench.force = ToVector3(result.force_M);
  message.wrench.torque = ToVector3(result.torque_M);
  return message;
}

SealState ToSealState(const StepResult& result, const std_msgs::Header& header) {
  SealState message;
  message.header = header;
  message.status = static_cast<std::uint8_t>(result.status);
  message.gauge_pressure = result.gauge_pressure;
  message.setpoint = result.setpoint;
  message.cavity_area = result.cavity_area;
  message.cavity_volume = result.cavity_volume;
  message.contact_force = result.contact_force;
  message.num_contacts = result.num_contacts;
  std::copy(result.zone_counts.begin(), result.zone_counts.end(), message.zone_counts.begin());
  message.bottleneck_gap = result.bottleneck_gap;
  message.opening_azimuth = result.opening.azimuth;
  message.opening_width = result.opening.width;
  message.opening_gap = result.opening.largest_gap;
  return message;
}

sensor_msgs::FluidPressure ToFluidPressure(const StepResult& result, double ambient_pressure,
                                           const std_msgs::Header& header) {
  sensor_msgs::FluidPressure message;
  message.header = header;
  message.fluid_pressure = ambient_pressure + result.gauge_pressure;
  message.variance = 0.0;
  return message;
}

sensor_msgs::PointCloud2 ToPointCloud(const StepResult& result, const CavitySurface& cavity,
                                      const std_msgs::Header& header) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.is_dense = true;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  using Field = sensor_msgs::PointField;
  modifier.setPointCloud2Fields(6, "x", 1, Field::FLOAT32, "y", 1, Field::FLOAT32, "z", 1,
                                Field::FLOAT32, "rgb", 1, Field::FLOAT32, "gap", 1, Field::FLOAT32,
                                "zone", 1, Field::UINT8);
  const std::size_t count =
      std::min(result.classification.zones.size(), static_cast<std::size_t>(cavity.num_points()));
  modifier.resize(count);

  sensor_msgs::PointCloud2Iterator<float> x(cloud, "x"), y(cloud, "y"), z(cloud, "z"),
      gap(cloud, "gap");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> rgb(cloud, "rgb"), zone(cloud, "zone");
  for (std::size_t i = 0; i < count; ++i, ++x, ++y, ++z, ++gap, ++rgb, ++zone) {
    const auto p_W = result.x_W.col(cavity.nodes[i]);
    *x = static_cast<float>(p_W.x());
    *y = static_cast<float>(p_W.y());
    *z = static_cast<float>(p_W.z());
    *gap = static_cast<float>(result.gap[i]);
    *zone = static_cast<std::uint8_t>(result.classification.zones[i]);
    const Rgb& color = ColorOf(result.classification.zones[i]);
    rgb[2] = color[0];  // 0x00rrggbb, little endian
    rgb[1] = color[1];
    rgb[0] = color[2];
    rgb[3] = 0;
  }
  return cloud;
}

geometry_msgs::TransformStamped ToTransform(const StepResult& result, const std::string& cup_frame,
                                            const std_msgs::Header& header) {
  return ToTransformStamped(result.X_WM, cup_frame, header);
}

std::vector<geometry_msgs::TransformStamped> ToTransforms(const StepResult& result,
                                                          const std::vector<RigidObject>& objects,
                                                          const std_msgs::Header& header) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].inertia) continue;
    transforms.push_back(ToTransformStamped(result.objects.at(i).X_WO, objects[i].name, header));
  }
  return transforms;
}

ContactWrenches ToContactWrenches(const StepResult& result, const std::vector<RigidObject>& objects,
                                  const std_msgs::Header& header) {
  ContactWrenches message;
  message.header = header;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const ObjectResult& object = result.objects.at(i);
    const Eigen::Matrix3d R_OW = object.X_WO.linear().transpose();
    ContactWrench wrench;
    wrench.name = objects[i].name;
    wrench.frame = objects[i].name;
    wrench.wrench.force = ToVector3(R_OW * object.force_W);
    wrench.wrench.torque = ToVector3(R_OW * object.torque_W);
    message.wrenches.push_back(std::move(wrench));
  }
  return message;
}

bool IsGrasping(const StepResult& result) {
  const bool airtight =
      result.status == SealStatus::kSealed || result.status == SealStatus::kRegulating;
  return airtight && result.gauge_pressure < 0.0;
}

}  // namespace vacuum_gripper_sim
