#pragma once

#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_object.h"

namespace vacuum_gripper_sim {

/** Reads the collision geometry of a URDF with urdfdom: box, sphere, cylinder, mesh. Every link with
 collision elements becomes an object, named as the link, which is its tf frame, and placed in the
 URDF's root link as all joints at zero have it.
 @param directory Where relative paths of meshes start; empty: they are refused.
 @throws std::invalid_argument naming the link and the reason: not a URDF, a size that is not finite
   or not positive, a mesh that cannot be read (see MeshFiles), no collision geometry at all. */
std::vector<RigidObject> ReadSceneUrdf(const std::string& xml, const std::string& directory = "");

}  // namespace vacuum_gripper_sim
