#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace vacuum_gripper_sim {

/// `key.path=value`, taken apart.
struct Override {
  std::string path;  ///< Dotted; list elements by index, such as `timeline.2.time`.
  YAML::Node value;  ///< Parsed as YAML.
};

/// @throws std::invalid_argument if there is no `=`, an empty key, or the value is not YAML.
Override ParseOverride(const std::string& assignment);

/** Sets one key in a document. Maps on the way that are absent are made (whether the key means
 anything is for the document's reader to say); lists do not grow.
 @throws std::invalid_argument naming the path: an index out of range, a key below a value. */
void ApplyOverride(const Override& override_, const YAML::Node& root);

}  // namespace vacuum_gripper_sim
