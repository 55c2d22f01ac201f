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
static_assert(SealState::LEAKING == static_cast<int>(SealStatus::kLeaking), "likewise");

geometry_msgs::Vector3 ToVector3(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

}  // namespace

std_msgs::Header MakeHeader(const ros::Time& stamp, const std::string& frame) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = frame;
  return header;
}

geometry_msgs::WrenchStamped ToWrench(const Eigen::Vector3d& force, const Eigen::Vector3d& torque,
                                      const std_msgs::Header& header) {
  geometry_msgs::WrenchStamped message;
  message.header = header;
  message.wrench.force = ToVector3(force);
  message.wrench.torque = ToVector3(torque);
  return message;
}

SealState ToSealState(const GripSummary& grip, double setpoint, const std_msgs::Header& header) {
  SealState message;
  message.header = header;
  message.status = static_cast<std::uint8_t>(grip.status);
  message.gauge_pressure = grip.gauge_pressure;
  message.setpoint = setpoint;
  message.cavity_area = grip.cavity_area;
  message.cavity_volume = grip.cavity_volume;
  message.contact_force = grip.contact_force;
  message.num_contacts = grip.num_contacts;
  std::copy(grip.zone_counts.begin(), grip.zone_counts.end(), message.zone_counts.begin());
  message.bottleneck_gap = grip.bottleneck_gap;
  message.opening_azimuth = grip.opening.azimuth;
  message.opening_width = grip.opening.width;
  message.opening_gap = grip.opening.largest_gap;
  message.leak_flow = grip.leak_flow;
  message.leak_area = grip.leak_area;
  return message;
}

sensor_msgs::FluidPressure ToFluidPressure(const GripSummary& grip, double ambient_pressure,
                                           const std_msgs::Header& header) {
  sensor_msgs::FluidPressure message;
  message.header = header;
  message.fluid_pressure = ambient_pressure + grip.gauge_pressure;
  message.variance = 0.0;
  return message;
}

VacuumState ToVacuumState(const VacuumReading& reading, double ambient_pressure,
                          const std_msgs::Header& header) {
  VacuumState message;
  message.header = header;
  message.in_control_range = reading.in_control_range;
  message.part_present = reading.part_present;
  message.part_detached = reading.part_detached;
  message.actual_power = reading.actual_power;
  message.absolute_pressure = reading.absolute_pressure;
  message.gauge_pressure = reading.absolute_pressure - ambient_pressure;
  message.flow = reading.flow;
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

geometry_msgs::TransformStamped ToTransform(const Eigen::Isometry3d& X_PF, const std::string& frame,
                                            const std_msgs::Header& header) {
  geometry_msgs::TransformStamped message;
  message.header = header;
  message.child_frame_id = frame;
  message.transform.translation = ToVector3(X_PF.translation());
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(X_PF.linear()).normalized();
  message.transform.rotation.x = rotation.x();
  message.transform.rotation.y = rotation.y();
  message.transform.rotation.z = rotation.z();
  message.transform.rotation.w = rotation.w();
  return message;
}

std::vector<geometry_msgs::TransformStamped> ToTransforms(const StepResult& result,
                                                          const std::vector<ObjectLabel>& objects,
                                                          const std_msgs::Header& header) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].is_free) continue;
    transforms.push_back(ToTransform(result.objects.at(i).X_WO, objects[i].name, header));
  }
  return transforms;
}

ContactWrenches ToContactWrenches(const StepResult& result, const std::vector<ObjectLabel>& objects,
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

bool IsGrasping(const GripSummary& grip) { return Holds(grip.status) && grip.gauge_pressure < 0.0; }

}  // namespace vacuum_gripper_sim
