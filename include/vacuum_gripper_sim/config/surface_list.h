#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_object.h"

namespace vacuum_gripper_sim {

/** Reads a list of rigid surfaces in the world, each a map of `name`, `type` (plane, box, sphere,
 cylinder, mesh), its dimensions (`size` [x, y, z] of a box, `radius`, `length` of a cylinder) [m]
 or its `file` and `scale` (see MeshFiles), `position` [m] (default: the origin) and `rotation`
 (default: none).
 @param name Dotted path of the list, for messages.
 @param directory Where relative paths of meshes start.
 @throws std::invalid_argument naming the key, its value and what is allowed. */
std::vector<RigidObject> ReadObjects(const YAML::Node& node, const std::string& name,
                                     const std::string& directory);

/// Reads a URDF's collision geometry, its links where the joints at zero put them and its root link
/// at the world's origin. @throws std::invalid_argument naming the file and the reason.
std::vector<RigidObject> ReadSceneFile(const std::string& path);

}  // namespace vacuum_gripper_sim
