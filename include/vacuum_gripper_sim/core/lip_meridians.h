#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"

namespace vacuum_gripper_sim {

/** Ways over the cavity surface from near the port to the border, one in the middle of each of
 kNumber equal sectors about the cup's axis.

 Each is where the half plane of its azimuth cuts the surface at rest: a chain of crossings with
 edges, straight in between. It is followed from triangle to triangle, so that the folds of a
 bellows are met in the order in which the air passes them, whatever their radius. What is nearer to
 the axis than a quarter of the border's mean radius is left out: it belongs to the port. */
struct LipMeridians {
  static constexpr int kNumber = 180;

  /// Where a meridian crosses an edge, and the same place on the next meridian.
  struct Crossing {
    int a{0}, b{0};  ///< Points at the ends of the edge.
    double t{0.0};   ///< The crossing is at (1 - t) a + t b.
    int beside{0};   ///< Crossing of the next meridian, not its last: the place opposite to this
    double beside_t{0.0};  ///< one is at (1 - beside_t) of `beside` + beside_t of the one after it.
  };
  /// Which crossings are a meridian's, from the port to the border.
  struct Chain {
    int inner{0};  ///< From here on they are kept, so that all have something beside them.
    int begin{0};  ///< From here on they count.
    int end{0};
  };

  std::vector<Crossing> crossings;  ///< Meridian by meridian.
  std::vector<Chain> chains;        ///< kNumber.
  double radius{0.0};               ///< Mean distance of the border from the axis. [m]

  /// Azimuth about the mount's z axis from its x axis, as in SealOpening. [rad]
  static double Azimuth(int meridian);
};

/** Follows the meridians.
 @param rest Rest positions of all mesh nodes, 3 by #nodes; the cup's axis is z. [m]
 @throws std::invalid_argument if the border does not go once round the axis. */
LipMeridians MakeLipMeridians(const CavitySurface& surface, const Eigen::Matrix3Xd& rest);

}  // namespace vacuum_gripper_sim
