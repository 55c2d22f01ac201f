#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_surface.h"

namespace vacuum_gripper_sim {

/// How a rigid object resists being moved.
struct RigidInertia {
  double mass{0.0};                                        ///< [kg] > 0
  Eigen::Vector3d p_OC{Eigen::Vector3d::Zero()};           ///< Centre of mass C in the object. [m]
  Eigen::Matrix3d about_C_O{Eigen::Matrix3d::Identity()};  ///< Rotational, about C, axes of O.
                                                           ///< [kg m^2]
};

/// Something that the cup touches. Frame O is its own; in a scene it is the link's frame.
struct RigidObject {
  std::string name;
  std::vector<RigidSurface> surfaces;                     ///< Fixed to O: X_FS is X_OS.
  Eigen::Isometry3d X_WO{Eigen::Isometry3d::Identity()};  ///< Pose of O in the world.
  /// Set: the object is free, it moves as gravity and contacts have it. Not set: it is where the
  /// user puts it.
  std::optional<RigidInertia> inertia;
  /// A free one's at first: of its origin. [m/s]
  Eigen::Vector3d velocity_W{Eigen::Vector3d::Zero()};
  /// Likewise. [rad/s]
  Eigen::Vector3d angular_velocity_W{Eigen::Vector3d::Zero()};
};

/// An object of one surface that stays where the surface is.
RigidObject FixedObject(RigidSurface surface);

/** Checks an object's numbers.
 @throws std::invalid_argument naming object, field, value and what is allowed: surfaces as
   Validate(const RigidSurface&), at least one of them; the pose finite and a rotation, velocities
   finite. Of a free one: no plane; mass finite and > 0; the rotational inertia finite, symmetric,
   positive definite and its principal moments those of a body: none larger than the sum of the
   others. */
void Validate(const RigidObject& object);

}  // namespace vacuum_gripper_sim
