#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace vacuum_gripper_sim {

/// A node on one line, for messages: `[1, 2]`, `{a: 1}`, `text`; long ones are cut.
std::string Describe(const YAML::Node& node);

/// Parses a decimal number in the C locale. Returns false unless the whole text is one.
bool ParseDouble(const std::string& text, double* value);

/// The scalar is text by the file's own word: it was quoted (or tagged as a string).
bool IsQuoted(const YAML::Node& node);

}  // namespace vacuum_gripper_sim
