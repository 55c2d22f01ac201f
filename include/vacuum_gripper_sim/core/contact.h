#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_surface.h"

namespace vacuum_gripper_sim {

/// One row of H_c: a node that may not pass a surface.
struct Contact {
  int node{0};             ///< Mesh node.
  int surface{0};          ///< Index of the rigid surface.
  double gap{0.0};         ///< Signed distance; < 0: penetrating. [m]
  Eigen::Vector3d normal;  ///< Out of the surface, world axes: d(gap)/dx.
};

/// The narrow phase: signed distances of nodes to all surfaces.
struct Proximity {
  std::vector<Contact> contacts;  ///< Pairs nearer than the alarm distance, nodes ascending.
  std::vector<double> distance;   ///< Of each asked node to its nearest surface; +inf: none. [m]
};

/** Measures where the nodes are.
 @param nodes The mesh nodes to ask for. @param x_W Positions of all mesh nodes, 3 by #nodes. [m]
 @param alarm_distance Pairs with a smaller signed distance become contacts. [m] */
Proximity DetectProximity(const std::vector<RigidSurface>& surfaces, const std::vector<int>& nodes,
                          const Eigen::Matrix3Xd& x_W, double alarm_distance);

/** Contacts of a motion that may end far inside a solid: gap(x0) + normal(x0) . (x1 - x0), with the
 side of the solid that the motion started from. Measured at its end, a thin plate would push a node
 that a free motion carried through its middle out on the wrong side.
 @param x0_W,x1_W Start and end of the motion, 3 by #nodes. [m] */
std::vector<Contact> DetectAhead(const std::vector<RigidSurface>& surfaces,
                                 const std::vector<int>& nodes, const Eigen::Matrix3Xd& x0_W,
                                 const Eigen::Matrix3Xd& x1_W, double alarm_distance);

}  // namespace vacuum_gripper_sim
