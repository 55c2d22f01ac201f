#include "vacuum_gripper_sim/config/surface_list.h"

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "vacuum_gripper_sim/config/mesh_file.h"
#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "vacuum_gripper_sim/config/scene_urdf.h"
#include "vacuum_gripper_sim/config/yaml_file.h"
#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

double ReadLength(ParameterReader* reader, const std::string& key) {
  const double length = reader->GetDouble(key);
  if (length <= 0.0) {
    throw std::invalid_argument(reader->Name(key) + " = " + Describe(reader->GetNode(key)) +
                                "; expected more than 0 [m]");
  }
  return length;
}

Shape ReadShape(ParameterReader* reader, MeshFiles* meshes) {
  reader->GetString("type");  // required: no shape is a good guess
  const std::string type =
      reader->GetChoice("type", {"plane", "box", "sphere", "cylinder", "mesh"}, "");
  if (type == "box") {
    const Eigen::Vector3d size = reader->GetVector3("size");
    if (size.minCoeff() <= 0.0) {
      throw std::invalid_argument(reader->Name("size") + " = " + Describe(reader->GetNode("size")) +
                                  "; expected three lengths of more than 0 [m]");
    }
    return Box{size};
  }
  if (type == "sphere") return Sphere{ReadLength(reader, "radius")};
  if (type == "cylinder") {
    const double radius = ReadLength(reader, "radius");
    return Cylinder{radius, ReadLength(reader, "length")};
  }
  if (type == "mesh") {
    const std::string file = reader->GetString("file");
    return meshes->Load(reader->Name("file"), file,
                        reader->GetVector3("scale", Eigen::Vector3d::Ones()));
  }
  return Plane{};
}

}  // namespace

std::vector<RigidObject> ReadObjects(const YAML::Node& node, const std::string& name,
                                     const std::string& directory) {
  if (!node.IsSequence()) {
    throw std::invalid_argument(name + " = " + Describe(node) + "; expected a list of surfaces");
  }
  MeshFiles meshes(directory);
  std::vector<RigidObject> objects;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const std::string path = name + "." + std::to_string(i);
    ParameterReader reader(node[i], path);
    RigidSurface surface;
    surface.name = reader.GetString("name", path);
    surface.shape = ReadShape(&reader, &meshes);
    surface.X_FS.translation() = reader.GetVector3("position", Eigen::Vector3d::Zero());
    surface.X_FS.linear() =
        reader.GetRotation("rotation", Eigen::Quaterniond::Identity()).toRotationMatrix();
    reader.CheckNoUnknownKeys();
    objects.push_back(FixedObject(std::move(surface)));
    Validate(objects.back());
  }
  return objects;
}

std::vector<RigidObject> ReadSceneFile(const std::string& path) {
  const std::string directory = std::filesystem::absolute(path).parent_path().string();
  try {
    return ReadSceneUrdf(ReadTextFile(path), directory);
  } catch (const std::invalid_argument& e) {
    const std::string reason = e.what();
    if (reason.find(path) != std::string::npos) throw;
    throw std::invalid_argument(path + ": " + reason);
  }
}

}  // namespace vacuum_gripper_sim
