#include "vacuum_gripper_sim/core/seal_tolerance.h"

#include <algorithm>
#include <cstddef>

namespace vacuum_gripper_sim {

double LipSagitta(const CavitySurface& cavity, const Eigen::Matrix3Xd& rest) {
  // Area vectors point into the material: out of it are the surface's normals.
  const Eigen::Matrix3Xd normals = -PointAreaVectors(cavity, rest).colwise().normalized();
  double largest = 0.0;
  for (std::size_t a = 0; a < cavity.neighbours.size(); ++a) {
    for (const int b : cavity.neighbours[a]) {
      const Eigen::Vector3d edge =
          rest.col(cavity.nodes[static_cast<std::size_t>(b)]) - rest.col(cavity.nodes[a]);
      // Of the turn of the normal, the part along the edge: > 0 where convex.
      const double turn =
          edge.dot(normals.col(b) - normals.col(static_cast<Eigen::Index>(a)));  // L a [m]
      largest = std::max(largest, turn / 8.0);
    }
  }
  return largest;
}

SealParameters ResolveSealGaps(SealParameters seal, double sagitta) {
  const double derived = std::max(sagitta, kFinestSealGap);
  if (!seal.close_gap) seal.close_gap = std::min(derived, seal.open_gap.value_or(derived));
  if (!seal.open_gap) seal.open_gap = std::max(derived, *seal.close_gap);
  return seal;
}

}  // namespace vacuum_gripper_sim
