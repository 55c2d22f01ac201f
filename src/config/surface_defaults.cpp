#include "vacuum_gripper_sim/config/surface_defaults.h"

#include <stdexcept>
#include <string>

#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

double ReadNotNegative(ParameterReader* reader, const std::string& key, double default_value,
                       const std::string& unit) {
  const double value = reader->GetDouble(key, default_value);
  if (value >= 0.0) return value;
  throw std::invalid_argument(reader->Name(key) + " = " + Describe(reader->GetNode(key)) +
                              "; expected 0 or more " + unit);
}

}  // namespace

SurfaceDefaults ReadSurfaceDefaults(ParameterReader* reader, const SurfaceDefaults& defaults) {
  SurfaceDefaults read;
  read.friction = ReadNotNegative(reader, "friction", defaults.friction, "[-]");
  read.roughness = ReadNotNegative(reader, "roughness", defaults.roughness, "[m]");
  return read;
}

}  // namespace vacuum_gripper_sim
