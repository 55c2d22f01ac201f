#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "vacuum_gripper_sim/config/surface_defaults.h"
#include "vacuum_gripper_sim/config/timeline.h"
#include "vacuum_gripper_sim/core/rigid_object.h"

namespace vacuum_gripper_sim {

/// An object that is where its keyframes put it; between them as Keyframe says.
struct ObjectMotion {
  int object{0};
  std::vector<Keyframe> keyframes;  ///< p_WM, q_WM are the object's; set-points are zero.
};

/// What a scenario's cup touches.
struct SurfaceList {
  std::vector<RigidObject> objects;
  std::vector<ObjectMotion> motions;
};

/** Reads a list of rigid objects in the world, each a map of `name`, `type` (plane, box, sphere,
 cylinder, mesh), its dimensions (`size` [x, y, z] of a box, `radius`, `length` of a cylinder) [m]
 or its `file` and `scale` (see MeshFiles), `friction` [-], `roughness` [m], `permeance`
 [m/(Pa s)], `holes` (a list of `{position [m], area [m^2]}`), and either `position` [m] (default:
 the origin) and `rotation` (default: none), or `motion`, see ReadMotion(). With `mass` [kg] it is
 free, its centre of mass in the middle, `inertia` [Ixx, Iyy, Izz] [kg m^2] about it is that of a
 uniform solid if not set (a mesh must say), and `velocity` [m/s] at first none.
 @param name Dotted path of the list, for messages.
 @param directory Where relative paths of meshes start.
 @param defaults Of those that do not say.
 @throws std::invalid_argument naming the key, its value and what is allowed. */
SurfaceList ReadObjects(const YAML::Node& node, const std::string& name,
                        const std::string& directory, const SurfaceDefaults& defaults = {});

/** Reads the motions of objects: a map from an object's name to keyframes, see ReadMotion().
 @param path Dotted path of the map, for messages.
 @throws std::invalid_argument naming the object: unknown, or free. */
std::vector<ObjectMotion> ReadMotions(const YAML::Node& node, const std::string& path,
                                      const std::vector<RigidObject>& objects);

/// Reads a URDF's collision geometry, its links where the joints at zero put them and its root link
/// at the world's origin. @throws std::invalid_argument naming the file and the reason.
/// @param defaults Of links that do not say.
std::vector<RigidObject> ReadSceneFile(const std::string& path,
                                       const SurfaceDefaults& defaults = {});

}  // namespace vacuum_gripper_sim
