#pragma once

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace vacuum_gripper_sim {

/// Checks of parameters: each throws std::invalid_argument with one line that names the field by
/// its dotted YAML path, its value and what is allowed.

inline void Require(bool allowed, const char* name, double value, const char* rule) {
  if (allowed) return;
  std::ostringstream message;
  message << name << " = " << value << ", must be " << rule;
  throw std::invalid_argument(message.str());
}

inline void RequirePositive(const char* name, double value, const char* unit) {
  const std::string rule = std::string("finite and > 0 ") + unit;
  Require(std::isfinite(value) && value > 0.0, name, value, rule.c_str());
}

inline void RequireNotNegative(const char* name, double value, const char* unit) {
  const std::string rule = std::string("finite and >= 0 ") + unit;
  Require(std::isfinite(value) && value >= 0.0, name, value, rule.c_str());
}

inline void RequireAtLeastOne(const char* name, int value) {
  Require(value >= 1, name, value, "at least 1");
}

}  // namespace vacuum_gripper_sim
