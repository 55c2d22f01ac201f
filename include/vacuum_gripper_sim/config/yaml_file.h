#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace vacuum_gripper_sim {

/** Reads a whole text file.
 @throws std::invalid_argument naming the file if it is missing, no regular file or unreadable. */
std::string ReadTextFile(const std::string& path);

/** Reads a YAML file whose document is a map.
 @throws std::invalid_argument naming the file, for a syntax error also its line and column. */
YAML::Node ReadYamlFile(const std::string& path);

/// Parses YAML. @param source Name for messages. @throws std::invalid_argument
/// "source:line:column".
YAML::Node ParseYaml(const std::string& text, const std::string& source);

}  // namespace vacuum_gripper_sim
