#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_surface.h"

namespace vacuum_gripper_sim {

/// A link of the scene: a tf frame with rigid surfaces fixed to it.
struct SceneLink {
  std::string name;                    ///< Link name = tf frame.
  std::vector<RigidSurface> surfaces;  ///< X_WS holds the pose in the link's frame, X_LS.
  /// Pose in the URDF's root link with all joints at zero: where the link is without tf.
  Eigen::Isometry3d X_RL{Eigen::Isometry3d::Identity()};
};

/** Reads the collision geometry of a URDF with urdfdom: box, sphere, cylinder, mesh. Links without
 collision elements are left out.
 @param directory Where relative paths of meshes start; empty: they are refused.
 @throws std::invalid_argument naming the link and the reason: not a URDF, a size that is not finite
   or not positive, a mesh that cannot be read (see MeshFiles), no collision geometry at all. */
std::vector<SceneLink> ReadSceneUrdf(const std::string& xml, const std::string& directory = "");

}  // namespace vacuum_gripper_sim
