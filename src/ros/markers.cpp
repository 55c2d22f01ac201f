#include "markers.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "zone_colors.h"

namespace vacuum_gripper_sim {
namespace {

using visualization_msgs::Marker;

constexpr double kMetresPerNewton =
    0.008;                               // Length of the force arrow: 5 N are one cup's diameter.
constexpr double kSmallestForce = 0.02;  // Below this there is no direction worth drawing. [N]
constexpr double kShaftWidth = 2.0e-3;   // Of the arrow. [m]
constexpr double kHeadWidth = 4.5e-3;
constexpr double kHeadLength = 6.0e-3;
constexpr double kWallThickness = 3.5e-3;  // Zones shine through up to here ... [m]
constexpr double kOpaqueThickness = 6e-3;  // ... and no more from here on. [m]
constexpr double kMaxTint = 0.65;
// The wrench acts at the mount's origin; its arrow is drawn beside it, clear of cup and flange. [m]
const Eigen::Vector3d kArrowOffset(0.020, -0.020, 0.0);
const Eigen::Vector3d kSilicone(0.72, 0.73, 0.76);

// A lamp above and to the side and a weaker one opposite, so that no face is left black.
const Eigen::Vector3d kKeyLight = Eigen::Vector3d(0.5, -0.6, 1.0).normalized();
const Eigen::Vector3d kFillLight = Eigen::Vector3d(-0.7, 0.6, -0.3).normalized();

double Shade(const Eigen::Vector3d& normal) {
  return 0.42 + 0.50 * std::max(0.0, normal.dot(kKeyLight)) +
         0.22 * std::max(0.0, normal.dot(kFillLight));
}

Eigen::Vector3d ToUnit(const Rgb& rgb) { return Eigen::Vector3d(rgb[0], rgb[1], rgb[2]) / 255.0; }

std_msgs::ColorRGBA ToColor(const Eigen::Vector3d& rgb) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(std::min(1.0, rgb.x()));
  color.g = static_cast<float>(std::min(1.0, rgb.y()));
  color.b = static_cast<float>(std::min(1.0, rgb.z()));
  color.a = 1.0F;
  return color;
}

geometry_msgs::Point ToPoint(const Eigen::Vector3d& p) {
  geometry_msgs::Point point;
  point.x = p.x();
  point.y = p.y();
  point.z = p.z();
  return point;
}

Marker MakeMarker(const std_msgs::Header& header, const std::string& name, int type, double scale) {
  Marker marker;
  marker.header = header;
  marker.ns = name;
  marker.id = 0;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = scale;
  marker.color = ToColor(kSilicone);
  return marker;
}

std::array<int, 3> SortedCorners(const Eigen::Matrix3Xi& triangles, Eigen::Index t) {
  std::array<int, 3> corners{{triangles(0, t), triangles(1, t), triangles(2, t)}};
  std::sort(corners.begin(), corners.end());
  return corners;
}

Marker PaintForce(const StepResult& result, const std_msgs::Header& header) {
  Marker marker = MakeMarker(header, "wrench", Marker::ARROW, 1.0);
  if (!(result.force_M.norm() > kSmallestForce)) {
    marker.action = Marker::DELETE;
    return marker;
  }
  const Eigen::Vector3d force_W = result.X_WM.linear() * result.force_M;
  // A pull ends at the mount's height, a push begins there: the arrow is never inside the object.
  const Eigen::Vector3d arrow_W = kMetresPerNewton * force_W;
  // Shorter than its head it shrinks as a whole, or rviz would squash it into a disc.
  const double share = std::min(1.0, arrow_W.norm() / kHeadLength);
  marker.scale.x = share * kShaftWidth;
  marker.scale.y = share * kHeadWidth;
  marker.scale.z = share * kHeadLength;
  marker.color = ToColor(Eigen::Vector3d(0.95, 0.45, 0.10));
  const Eigen::Vector3d mount_W = result.X_WM * kArrowOffset;
  const Eigen::Vector3d foot_W = result.force_M.z() > 0.0 ? mount_W - arrow_W : mount_W;
  marker.points = {ToPoint(foot_W), ToPoint(foot_W + arrow_W)};
  return marker;
}

}  // namespace

MarkerPainter::MarkerPainter(const TetMesh& mesh, const CavitySurface& cavity)
    : cavity_nodes_(cavity.nodes), triangles_(SplitFaces(mesh.boundary_faces)) {
  const Eigen::Matrix3Xi cavity_triangles = SplitFaces(mesh.cavity_faces);
  std::set<std::array<int, 3>> in_cavity;
  for (Eigen::Index t = 0; t < cavity_triangles.cols(); ++t) {
    in_cavity.insert(SortedCorners(cavity_triangles, t));
  }
  inner_.resize(static_cast<std::size_t>(triangles_.cols()));
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
    inner_[static_cast<std::size_t>(t)] = in_cavity.count(SortedCorners(triangles_, t)) > 0;
  }

  const auto num_nodes = static_cast<std::size_t>(mesh.num_nodes());
  tint_point_.assign(num_nodes, -1);
  tint_.assign(num_nodes, 0.0);
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    double nearest = std::numeric_limits<double>::infinity();
    const auto n = static_cast<std::size_t>(node);
    for (int point = 0; point < cavity.num_points(); ++point) {
      const int other = cavity.nodes[static_cast<std::size_t>(point)];
      const double distance = (mesh.nodes.col(node) - mesh.nodes.col(other)).norm();
      if (distance < nearest) {
        nearest = distance;
        tint_point_[n] = point;
      }
    }
    const double opacity = (nearest - kWallThickness) / (kOpaqueThickness - kWallThickness);
    tint_[n] = kMaxTint * (1.0 - std::clamp(opacity, 0.0, 1.0));
  }
}

visualization_msgs::MarkerArray MarkerPainter::Paint(const StepResult& result,
                                                     const std_msgs::Header& header) const {
  visualization_msgs::MarkerArray array;
  // One by one: a braced list would copy them, hundreds of kilobytes.
  array.markers.reserve(3);
  array.markers.push_back(PaintSkin(result, header));
  array.markers.push_back(PaintZones(result, header));
  array.markers.push_back(PaintForce(result, header));
  return array;
}

Marker MarkerPainter::PaintSkin(const StepResult& result, const std_msgs::Header& header) const {
  // Normals of the nodes, inner and outer skin apart: they meet at a sharp rim.
  Eigen::Matrix3Xd outer_normals = Eigen::Matrix3Xd::Zero(3, result.x_W.cols());
  Eigen::Matrix3Xd inner_normals = outer_normals;
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
    const Eigen::Vector3d p0 = result.x_W.col(triangles_(0, t));
    const Eigen::Vector3d area =
        (result.x_W.col(triangles_(1, t)) - p0).cross(result.x_W.col(triangles_(2, t)) - p0);
    Eigen::Matrix3Xd& normals = inner_[static_cast<std::size_t>(t)] ? inner_normals : outer_normals;
    for (int k = 0; k < 3; ++k) normals.col(triangles_(k, t)) += area;
  }
  outer_normals.colwise().normalize();
  inner_normals.colwise().normalize();

  Marker marker = MakeMarker(header, "deformed_mesh", Marker::TRIANGLE_LIST, 1.0);
  marker.points.reserve(static_cast<std::size_t>(3 * triangles_.cols()));
  marker.colors.reserve(static_cast<std::size_t>(3 * triangles_.cols()));
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
    const bool inner = inner_[static_cast<std::size_t>(t)];
    for (int k = 0; k < 3; ++k) {
      const int node = triangles_(k, t);
      const auto n = static_cast<std::size_t>(node);
      const Zone zone = result.classification.zones[static_cast<std::size_t>(tint_point_[n])];
      const double tint = inner ? 1.0 : tint_[n];
      const Eigen::Vector3d color = (1.0 - tint) * kSilicone + tint * ToUnit(ColorOf(zone));
      const auto& normals = inner ? inner_normals : outer_normals;
      marker.points.push_back(ToPoint(result.x_W.col(node)));
      marker.colors.push_back(ToColor(Shade(normals.col(node)) * color));
    }
  }
  return marker;
}

Marker MarkerPainter::PaintZones(const StepResult& result, const std_msgs::Header& header) const {
  Marker marker = MakeMarker(header, "zones", Marker::POINTS, 0.4e-3);
  marker.points.reserve(cavity_nodes_.size());
  marker.colors.reserve(cavity_nodes_.size());
  for (std::size_t i = 0; i < cavity_nodes_.size(); ++i) {
    marker.points.push_back(ToPoint(result.x_W.col(cavity_nodes_[i])));
    marker.colors.push_back(ToColor(ToUnit(ColorOf(result.classification.zones[i]))));
  }
  return marker;
}

}  // namespace vacuum_gripper_sim
