#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"

namespace vacuum_gripper_sim {

/// A way out across an edge of the cavity surface whose ends are closed: over a hole or a slot that
/// is narrower than the edge is long.
struct EdgeWay {
  int a{0}, b{0};      ///< Points at the ends of the edge.
  int from{0}, to{0};  ///< Points opposite to it in its two triangles, which the way joins.
  double gap{0.0};     ///< The largest along the edge. [m]
};

/// Distance of a point to the nearest rigid surface. [m]
using DistanceToSurfaces = std::function<double(const Eigen::Vector3d& p_W)>;

/** Looks for what the points of a cavity surface cannot see, because it lies between them.

 Edges whose ends are both closed are measured at three places in between. So a hole is seen if it
 takes up more than about half an edge; on a plane there is nothing to see. */
class EdgeWays {
 public:
  explicit EdgeWays(const CavitySurface& surface);

  /** The edges that are open between closed ends.
   @param phi Opening of each point, as for Classify(). [m] @param open_gap What counts as open. [m]
   @param x_W Positions of all mesh nodes, 3 by #nodes. [m] */
  std::vector<EdgeWay> Find(const std::vector<double>& phi, double open_gap,
                            const Eigen::Matrix3Xd& x_W, const DistanceToSurfaces& distance) const;

 private:
  std::vector<EdgeWay> edges_;  // all that have two triangles, with a gap of 0
  std::vector<int> nodes_;      // of the points
};

}  // namespace vacuum_gripper_sim
