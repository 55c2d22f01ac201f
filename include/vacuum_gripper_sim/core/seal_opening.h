#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/classifier.h"

namespace vacuum_gripper_sim {

/// Where and how far a cavity is open to the ambient. All zero when it is airtight.
struct SealOpening {
  double azimuth{0.0};  ///< Of the middle of the opening, about the mount's z axis from its x axis,
                        ///< -pi to pi; where it goes all round, of its widest meridian. [rad]
  double width{0.0};    ///< Angle about the mount's axis that the opening takes; 2 pi: all round,
                        ///< as in the air. [rad]
  double largest_gap{0.0};  ///< Of the widest way out; +inf without surfaces. [m]
};

/** Locates the opening of a cup's cavity that is not airtight.

 A meridian is the line on the cavity surface from port to rim at one azimuth about the mount's
 axis; its gap G is the smallest on it, and usually that of the lip's lowest point there. Gaps run
 linearly along the edges of the surface, with a peak in the middle of one that is open between
 closed ends. The opening is the range of azimuths over which G exceeds `open_gap`, without
 interruption; of several it is the one with the largest G. G is sampled every 2 degrees, and linear
 in between. A way out that winds across the meridians so that none is open from end to end counts
 as an opening of 2 degrees at the azimuth of the largest G. The largest gap is that of the
 classifier, whose ways out may wind.

 @param cup Which of the surface's. @param gap Of every point of the surface. [m] @param
 classification Of it; the cavity is airtight if the bottleneck gap does not exceed open_gap. @param
 open_gap What the seal tolerates. [m]
 @param x_W Positions of all mesh nodes, 3 by #nodes. [m] @param X_WC Pose of the cup's mount. */
SealOpening FindSealOpening(const CavitySurface& surface, int cup, const std::vector<double>& gap,
                            const Classification& classification, double open_gap,
                            const Eigen::Matrix3Xd& x_W, const Eigen::Isometry3d& X_WC);

}  // namespace vacuum_gripper_sim
