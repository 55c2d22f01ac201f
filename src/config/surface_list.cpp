#include "vacuum_gripper_sim/config/surface_list.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "solid_inertia.h"
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

/// Free if it has a mass.
std::optional<RigidInertia> ReadInertia(ParameterReader* reader, const Shape& shape) {
  if (!reader->Has("mass")) {
    if (!reader->Has("inertia")) return std::nullopt;
    throw std::invalid_argument(reader->Name("inertia") + " is set without mass; expected both");
  }
  for (const char* key : {"motion", "inertia"}) {  // known, whatever comes
    reader->GetNode(key);
  }
  const double mass = reader->GetDouble("mass");
  if (mass <= 0.0) {
    throw std::invalid_argument(reader->Name("mass") + " = " + Describe(reader->GetNode("mass")) +
                                "; expected more than 0 [kg]");
  }
  if (reader->Has("motion")) {
    throw std::invalid_argument(reader->Name("motion") +
                                " is set and mass too; expected only one: a free object moves by "
                                "itself");
  }
  RigidInertia inertia;
  inertia.mass = mass;
  if (std::holds_alternative<Plane>(shape)) {
    throw std::invalid_argument(reader->Name("mass") +
                                " is set for a plane; expected a box, sphere, cylinder or mesh");
  }
  if (reader->Has("inertia")) {
    inertia.about_C_O = reader->GetVector3("inertia").asDiagonal();
    return inertia;
  }
  const std::optional<Eigen::Vector3d> solid = SolidInertia(shape, mass);
  if (!solid) {
    throw std::invalid_argument(reader->Name("inertia") +
                                " is not set; expected [Ixx, Iyy, Izz] of a free mesh [kg m^2]");
  }
  inertia.about_C_O = solid->asDiagonal();
  return inertia;
}

/// Where it is at first; `motion` stays empty if it has none.
Eigen::Isometry3d ReadPose(ParameterReader* reader, std::vector<Keyframe>* motion) {
  if (reader->Has("motion")) {
    for (const char* key : {"position", "rotation"}) {
      if (!reader->Has(key)) continue;
      throw std::invalid_argument(reader->Name(key) +
                                  " is set and motion too; expected only one of them");
    }
    *motion = ReadMotion(reader->GetNode("motion"), reader->Name("motion"));
    return PoseAt(*motion, 0.0);
  }
  Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
  X_WO.translation() = reader->GetVector3("position", Eigen::Vector3d::Zero());
  X_WO.linear() =
      reader->GetRotation("rotation", Eigen::Quaterniond::Identity()).toRotationMatrix();
  return X_WO;
}

}  // namespace

SurfaceList ReadObjects(const YAML::Node& node, const std::string& name,
                        const std::string& directory, double friction) {
  if (!node.IsSequence()) {
    throw std::invalid_argument(name + " = " + Describe(node) + "; expected a list of surfaces");
  }
  MeshFiles meshes(directory);
  SurfaceList list;
  std::set<std::string> names;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const std::string path = name + "." + std::to_string(i);
    ParameterReader reader(node[i], path);
    RigidSurface surface;
    surface.name = reader.GetString("name", path);
    if (!names.insert(surface.name).second) {
      throw std::invalid_argument(path + ".name = " + surface.name +
                                  " is that of another surface; expected a name of its own");
    }
    surface.shape = ReadShape(&reader, &meshes);
    surface.friction = ReadFriction(&reader, friction);
    surface.roughness = reader.GetDouble("roughness", surface.roughness);
    surface.permeance = reader.GetDouble("permeance", surface.permeance);
    RigidObject object = FixedObject(std::move(surface));
    object.inertia = ReadInertia(&reader, object.surfaces.front().shape);
    if (object.inertia) object.velocity_W = reader.GetVector3("velocity", object.velocity_W);
    ObjectMotion motion;
    motion.object = static_cast<int>(i);
    object.X_WO = ReadPose(&reader, &motion.keyframes);
    reader.CheckNoUnknownKeys();
    try {
      Validate(object);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(path + ": " + e.what());
    }
    list.objects.push_back(std::move(object));
    if (!motion.keyframes.empty()) list.motions.push_back(std::move(motion));
  }
  return list;
}

std::vector<ObjectMotion> ReadMotions(const YAML::Node& node, const std::string& path,
                                      const std::vector<RigidObject>& objects) {
  if (!node.IsMap()) {
    throw std::invalid_argument(path + " = " + Describe(node) +
                                "; expected a map from an object's name to keyframes");
  }
  std::vector<ObjectMotion> motions;
  for (const auto& entry : node) {
    const auto name = entry.first.as<std::string>();
    const auto object =
        std::find_if(objects.begin(), objects.end(),
                     [&](const RigidObject& candidate) { return candidate.name == name; });
    if (object == objects.end() || object->inertia) {
      throw std::invalid_argument(path + "." + name + " is " +
                                  (object == objects.end() ? "no object" : "free") +
                                  "; expected the name of a fixed object of the scene");
    }
    ObjectMotion motion;
    motion.object = static_cast<int>(object - objects.begin());
    motion.keyframes = ReadMotion(entry.second, path + "." + name);
    motions.push_back(std::move(motion));
  }
  return motions;
}

double ReadFriction(ParameterReader* reader, double default_value) {
  const double friction = reader->GetDouble("friction", default_value);
  if (friction >= 0.0) return friction;
  throw std::invalid_argument(reader->Name("friction") + " = " +
                              Describe(reader->GetNode("friction")) + "; expected 0 or more [-]");
}

std::vector<RigidObject> ReadSceneFile(const std::string& path, double friction) {
  const std::string directory = std::filesystem::absolute(path).parent_path().string();
  try {
    return ReadSceneUrdf(ReadTextFile(path), directory, friction);
  } catch (const std::invalid_argument& e) {
    const std::string reason = e.what();
    if (reason.find(path) != std::string::npos) throw;
    throw std::invalid_argument(path + ": " + reason);
  }
}

}  // namespace vacuum_gripper_sim
