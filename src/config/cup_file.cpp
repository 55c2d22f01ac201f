#include "vacuum_gripper_sim/config/cup_file.h"

#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "vacuum_gripper_sim/config/yaml_file.h"
#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

namespace fs = std::filesystem;

/// `path` below `directory` unless it is absolute, without dots in the way.
std::string Absolute(const std::string& path, const std::string& directory) {
  return fs::absolute(fs::path(directory) / path).lexically_normal().string();
}

std::string ShippedCups(const std::string& cup_directory) {
  std::set<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(cup_directory, error)) {
    if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string FindCupFile(const std::string& name, const std::string& directory,
                        const std::string& cup_directory) {
  const fs::path path(name);
  const bool bare = !path.has_parent_path() && path.extension() != ".yaml";
  std::string file = bare ? Absolute(name + ".yaml", cup_directory) : Absolute(name, directory);
  std::error_code error;
  if (!name.empty() && fs::is_regular_file(file, error)) return file;
  throw std::invalid_argument("cup = " + (name.empty() ? "(empty text)" : name) + ": no file " +
                              file + "; expected a cup that ships with the package (" +
                              ShippedCups(cup_directory) + "), a path or a map");
}

}  // namespace

YAML::Node ResolveCup(const YAML::Node& node, const std::string& directory,
                      const std::string& cup_directory) {
  const std::string expected = "; expected a cup's name, a path or a map";
  if (!node.IsDefined() || node.IsNull()) throw std::invalid_argument("cup is not set" + expected);
  YAML::Node cup;
  std::string base = directory;
  if (node.IsScalar()) {
    const std::string file = FindCupFile(node.Scalar(), directory, cup_directory);
    base = fs::path(file).parent_path().string();
    cup = ReadYamlFile(file);
  } else if (node.IsMap()) {
    cup = YAML::Clone(node);
  } else {
    throw std::invalid_argument("cup = " + Describe(node) + expected);
  }
  const YAML::Node mesh = std::as_const(cup)["mesh"];
  if (mesh.IsDefined() && mesh.IsScalar() && !mesh.Scalar().empty()) {
    cup["mesh"] = Absolute(mesh.Scalar(), base);
  }
  return cup;
}

Cup ReadCup(const YAML::Node& node, const std::string& directory,
            const std::string& cup_directory) {
  ParameterReader reader(ResolveCup(node, directory, cup_directory), "cup");
  Cup cup;
  cup.mesh_file = reader.GetString("mesh");
  cup.name = reader.GetString("name", fs::path(cup.mesh_file).stem().string());
  cup.material.young_modulus = reader.GetDouble("young_modulus");
  cup.material.poisson_ratio = reader.GetDouble("poisson_ratio");
  cup.material.density = reader.GetDouble("density");
  const std::string model =
      reader.GetChoice("material", {"corotational", "neo_hookean"}, "corotational");
  cup.material.model =
      model == "neo_hookean" ? MaterialModel::kNeoHookean : MaterialModel::kCorotational;
  ParameterReader damping = reader.GetMap("damping");
  cup.damping.mass = damping.GetDouble("mass", cup.damping.mass);
  cup.damping.stiffness = damping.GetDouble("stiffness", cup.damping.stiffness);
  damping.CheckNoUnknownKeys();
  reader.CheckNoUnknownKeys();
  std::error_code error;
  if (!fs::is_regular_file(cup.mesh_file, error)) {
    throw std::invalid_argument("cup.mesh = " + cup.mesh_file +
                                ": no such file; expected a Gmsh mesh");
  }
  return cup;
}

}  // namespace vacuum_gripper_sim
