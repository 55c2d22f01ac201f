#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/contact_finder.h"
#include "vacuum_gripper_sim/core/rigid_world.h"

namespace vacuum_gripper_sim {

/// What the cup does to an object, as force and torque about the object's origin, world axes.
struct ObjectLoad {
  Eigen::Vector3d force_W{Eigen::Vector3d::Zero()};   ///< [N]
  Eigen::Vector3d torque_W{Eigen::Vector3d::Zero()};  ///< About the object's origin. [N m]
};

/** What the cavity's pressure does to the objects before it.

 Gas has no mass: it pushes on the surface before a point of the cup as hard as on that point, and
 the object takes the sum, -sum f_i and -sum r_i x f_i, whatever its shape. Nothing else closes the
 balance of forces between cup and object: taking away what a pressure cannot do to a certain shape,
 as turning a ball, drives a hanging object into growing oscillations.

 @param load Of the pressure on the cup's nodes, 3 by #nodes. [N] @param x_W Where they are. [m]
 @param finder Knows which surface is before a node.
 @param[out] loads One for every object. */
void PressureOnObjects(const Eigen::Matrix3Xd& load, const Eigen::Matrix3Xd& x_W,
                       const ContactFinder& finder, const RigidWorld& world,
                       std::vector<ObjectLoad>* loads);

}  // namespace vacuum_gripper_sim
