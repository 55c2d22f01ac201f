#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/classifier.h"

namespace vacuum_gripper_sim {

/// How large the part of a cup's cavity is that its pressure acts on.
struct CavitySize {
  Eigen::Vector3d area_W{Eigen::Vector3d::Zero()};  ///< Sum of area vectors, into the cup. [m^2]
  double volume{0.0};  ///< Up to the plane across the edge of the wet points. [m^3]
};

/** @param cup Which of the surface's. @param wet By point. @param x_W Positions of all mesh nodes,
 3 by #nodes. [m] @param area_vectors Of the points, see PointAreaVectors(). [m^2] */
CavitySize SizeOfCavity(const CavitySurface& surface, int cup, const std::vector<bool>& wet,
                        const Eigen::Matrix3Xd& x_W, const Eigen::Matrix3Xd& area_vectors);

/// How many of a cup's points are in each zone. @param zones By point of the surface.
std::array<std::uint32_t, kNumZones> CountZones(const CavitySurface& surface, int cup,
                                                const std::vector<Zone>& zones);

}  // namespace vacuum_gripper_sim
