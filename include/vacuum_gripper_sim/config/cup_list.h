#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

/** Reads where a gripper's cups are: a list of maps `{name, position [m], orientation}` of each
 cup's mount in the gripper's, its z along suction; the orientation as quaternion [x, y, z, w] or
 [roll, pitch, yaw] [rad], none by default. All cups are equal: the one that `cup` describes.
 @param name Dotted path of the list, for messages.
 @throws std::invalid_argument naming the key, its value and what is allowed: no list or an empty
   one, unknown keys, wrong types, a name that is no base name of a ROS graph resource (a letter,
   then letters, digits and underscores) or that another cup has. */
std::vector<CupMount> ReadCupMounts(const YAML::Node& node, const std::string& name);

}  // namespace vacuum_gripper_sim
