#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/config/surface_defaults.h"
#include "vacuum_gripper_sim/core/rigid_object.h"

namespace vacuum_gripper_sim {

/// A link of a scene with something to touch.
struct SceneLink {
  RigidObject object;  ///< Named as the link; X_WO is its pose in the URDF's root link.
  std::string parent;  ///< Link above; empty: it is the root.
  Eigen::Isometry3d X_PO{Eigen::Isometry3d::Identity()};  ///< Pose in it, its joint at zero.
};

/** Reads the collision geometry of a URDF with urdfdom: box, sphere, cylinder, mesh. Every link
 with collision elements becomes an object, named as the link, which is its tf frame, and placed in
 the URDF's root link as all joints at zero have it.

 A link whose parent joint is `floating` is a free object with the mass, centre of mass and inertia
 of its `<inertial>`. Friction of a collision element is `<friction mu="0.5"/>` in it (urdfdom, like
 others, passes over it), else Gazebo's `<gazebo reference="LINK"><mu1>0.5</mu1></gazebo>` of the
 link. What air finds is said likewise in the element: `<air roughness="2.0e-6" permeance="0"/>`
 [m], [m/(Pa s)], and any number of `<hole xyz="0 0 0" area="1.0e-6"/>` [m], [m^2], in the frame of
 the element's shape.
 @param directory Where relative paths of meshes start; empty: they are refused.
 @param defaults Of those of which the URDF says nothing.
 @throws std::invalid_argument naming the link and the reason: not a URDF, a size that is not finite
   or not positive, a mesh that cannot be read (see MeshFiles), no collision geometry at all; two
 links of one name, two parents, a cycle; a free link without inertial or collision, with a mass or
 inertia that no body has, or with collision geometry in a link below it; negative friction. */
std::vector<SceneLink> ReadSceneLinks(const std::string& xml, const std::string& directory,
                                      const SurfaceDefaults& defaults);

/// The objects of ReadSceneLinks().
std::vector<RigidObject> ReadSceneUrdf(const std::string& xml, const std::string& directory = "",
                                       const SurfaceDefaults& defaults = {});

}  // namespace vacuum_gripper_sim
