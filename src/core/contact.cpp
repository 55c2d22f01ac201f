#include "vacuum_gripper_sim/core/contact.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace vacuum_gripper_sim {

Proximity DetectProximity(const std::vector<RigidSurface>& surfaces, const std::vector<int>& nodes,
                          const Eigen::Matrix3Xd& x_W, double alarm_distance) {
  Proximity proximity;
  proximity.distance.assign(nodes.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const SurfaceDistance seen = Distance(surfaces[s], x_W.col(nodes[i]));
      proximity.distance[i] = std::min(proximity.distance[i], seen.distance);
      if (seen.distance < alarm_distance) {
        proximity.contacts.push_back({nodes[i], static_cast<int>(s), seen.distance, seen.normal});
      }
    }
  }
  return proximity;
}

std::vector<Contact> DetectAhead(const std::vector<RigidSurface>& surfaces,
                                 const std::vector<int>& nodes, const Eigen::Matrix3Xd& x0_W,
                                 const Eigen::Matrix3Xd& x1_W, double alarm_distance) {
  std::vector<Contact> contacts;
  for (const int node : nodes) {
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const SurfaceDistance seen = Distance(surfaces[s], x0_W.col(node));
      const double gap = seen.distance + seen.normal.dot(x1_W.col(node) - x0_W.col(node));
      if (gap < alarm_distance) {
        contacts.push_back({node, static_cast<int>(s), gap, seen.normal});
      }
    }
  }
  return contacts;
}

}  // namespace vacuum_gripper_sim
