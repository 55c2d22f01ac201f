#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// A cup as described by a file in config/cups/.
struct Cup {
  std::string name;
  std::string mesh_file;  ///< Absolute path.
  Material material;
  RayleighDamping damping;
};

/** Reads the YAML map of a cup: `name`, `mesh` (path, relative to the cup's file), `young_modulus`
 [Pa], `poisson_ratio` [-], `density` [kg/m^3], `material` (`corotational`, the default, or
 `neo_hookean`), `damping: {mass [1/s], stiffness [s]}`.
 @param node      The map, or a scalar: a file name, or the bare name of a file in `cup_directory`.
 @param directory Directory that relative paths in the map (or the scalar) are relative to.
 @param cup_directory Directory of the cups that ship with the package (config/cups).
 @throws std::invalid_argument with one clear line. */
Cup ReadCup(const YAML::Node& node, const std::string& directory, const std::string& cup_directory);

/** Replaces a cup given by name or file by the map in that file, its mesh path made absolute, so
 that single keys can be overridden (`cup.young_modulus`). A map is returned with its mesh made
 absolute. */
YAML::Node ResolveCup(const YAML::Node& node, const std::string& directory,
                      const std::string& cup_directory);

}  // namespace vacuum_gripper_sim
