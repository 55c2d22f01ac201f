#include "vacuum_gripper_sim/config/scene_urdf.h"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <utility>

#include "scene_xml.h"
#include "vacuum_gripper_sim/config/mesh_file.h"

namespace vacuum_gripper_sim {
namespace {

/// Keeps urdfdom's complaints instead of printing them: the reason belongs into our one line. The
/// first says what, the later ones where.
class ComplaintCatcher : public console_bridge::OutputHandler {
 public:
  ComplaintCatcher() { console_bridge::useOutputHandler(this); }
  ~ComplaintCatcher() override { console_bridge::restorePreviousOutputHandler(); }
  ComplaintCatcher(const ComplaintCatcher&) = delete;
  ComplaintCatcher& operator=(const ComplaintCatcher&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    complaint_ += (complaint_.empty() ? "" : "; ") + text;
  }
  const std::string& complaint() const { return complaint_; }

 private:
  std::string complaint_;
};

urdf::ModelInterfaceSharedPtr Parse(const std::string& xml) {
  const ComplaintCatcher catcher;
  urdf::ModelInterfaceSharedPtr model;
  std::string reason;
  try {
    model = urdf::parseURDF(xml);
    reason = catcher.complaint();
  } catch (const std::exception& e) {
    reason = e.what();
  }
  // A model comes even where links could not be read to their end.
  if (model == nullptr || !reason.empty()) {
    throw std::invalid_argument("scene: not a valid URDF: " +
                                (reason.empty() ? "no robot element" : reason));
  }
  return model;
}

Eigen::Isometry3d ToIsometry(const urdf::Pose& pose) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  const urdf::Rotation& q = pose.rotation;
  X.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  return X;
}

Shape ToShape(const urdf::Geometry& geometry, const std::string& link, MeshFiles* meshes) {
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const urdf::Vector3& dim = static_cast<const urdf::Box&>(geometry).dim;
      return Box{Eigen::Vector3d(dim.x, dim.y, dim.z)};
    }
    case urdf::Geometry::SPHERE:
      return Sphere{static_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      return Cylinder{cylinder.radius, cylinder.length};
    }
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      return meshes->Load("scene: link " + link + ": mesh filename", mesh.filename,
                          {mesh.scale.x, mesh.scale.y, mesh.scale.z});
    }
    default:
      throw std::invalid_argument("scene: link " + link +
                                  ": unknown collision geometry; expected box, sphere, cylinder "
                                  "or mesh");
  }
}

/// The model and what urdfdom passes over in it.
struct Scene {
  urdf::ModelInterfaceSharedPtr model;
  const SceneXml& xml;
  SurfaceDefaults defaults;  // where the URDF says nothing
  MeshFiles* meshes;
};

[[noreturn]] void Refuse(const std::string& link, const std::string& reason) {
  throw std::invalid_argument("scene: link " + link + ": " + reason);
}

std::vector<RigidSurface> ReadSurfaces(const Scene& scene, const urdf::Link& link) {
  std::vector<RigidSurface> surfaces;
  for (const urdf::CollisionSharedPtr& collision : link.collision_array) {
    if (collision == nullptr || collision->geometry == nullptr) {
      Refuse(link.name,
             "a collision element without geometry; expected box, sphere, cylinder or mesh");
    }
    RigidSurface surface;
    surface.name = link.name;
    surface.shape = ToShape(*collision->geometry, link.name, scene.meshes);
    surface.X_FS = ToIsometry(collision->origin);
    const std::size_t number = surfaces.size();
    surface.friction = scene.xml.Friction(link.name, number).value_or(scene.defaults.friction);
    surface.roughness = scene.defaults.roughness;
    scene.xml.ReadAir(link.name, number, &surface);
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

RigidInertia ToInertia(const urdf::Inertial& inertial) {
  RigidInertia inertia;
  inertia.mass = inertial.mass;
  const Eigen::Isometry3d X_OC = ToIsometry(inertial.origin);
  inertia.p_OC = X_OC.translation();
  Eigen::Matrix3d about_C_C;
  about_C_C << inertial.ixx, inertial.ixy, inertial.ixz,  //
      inertial.ixy, inertial.iyy, inertial.iyz,           //
      inertial.ixz, inertial.iyz, inertial.izz;
  inertia.about_C_O = X_OC.linear() * about_C_C * X_OC.linear().transpose();
  return inertia;
}

bool IsFree(const urdf::Link& link) {
  return link.parent_joint != nullptr && link.parent_joint->type == urdf::Joint::FLOATING;
}

RigidObject ReadObject(const Scene& scene, const urdf::Link& link, const Eigen::Isometry3d& X_RL) {
  RigidObject object;
  object.name = link.name;
  object.surfaces = ReadSurfaces(scene, link);
  object.X_WO = X_RL;
  if (IsFree(link)) {
    const std::string joint = "its joint " + link.parent_joint->name + " is floating";
    if (link.inertial == nullptr) {
      Refuse(link.name,
             "no inertial element, but " + joint + "; expected mass and inertia of a free object");
    }
    if (object.surfaces.empty()) {
      Refuse(link.name, "no collision element, but " + joint + "; expected at least one");
    }
    object.inertia = ToInertia(*link.inertial);
  }
  if (object.surfaces.empty()) return object;
  try {
    Validate(object);
  } catch (const std::invalid_argument& e) {
    const std::string reason = e.what();
    const std::string prefix = "object '" + object.name + "': ";  // said already
    Refuse(link.name,
           reason.compare(0, prefix.size(), prefix) == 0 ? reason.substr(prefix.size()) : reason);
  }
  return object;
}

/// Depth first from the root, so that parents come before their children.
/// @param free The free link above this one; null: none.
void Collect(const Scene& scene, const urdf::Link& link, const Eigen::Isometry3d& X_RL,
             const urdf::Link* free, std::vector<SceneLink>* links) {
  SceneLink found;
  found.object = ReadObject(scene, link, X_RL);
  if (!found.object.surfaces.empty()) {
    if (free != nullptr) {
      Refuse(link.name, "has collision geometry below the free link " + free->name +
                            "; expected it in the free link itself");
    }
    if (link.parent_joint != nullptr) {
      found.parent = link.parent_joint->parent_link_name;
      found.X_PO = ToIsometry(link.parent_joint->parent_to_joint_origin_transform);
    }
    links->push_back(std::move(found));
  }
  if (IsFree(link)) free = &link;
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    Collect(scene, *child, X_RL * ToIsometry(child->parent_joint->parent_to_joint_origin_transform),
            free, links);
  }
}

}  // namespace

std::vector<SceneLink> ReadSceneLinks(const std::string& xml, const std::string& directory,
                                      const SurfaceDefaults& defaults) {
  const SceneXml scene_xml(xml);
  scene_xml.CheckTree();  // urdfdom leaves a cycle out and says nothing
  MeshFiles meshes(directory);
  const Scene scene{Parse(xml), scene_xml, defaults, &meshes};
  std::vector<SceneLink> links;
  Collect(scene, *scene.model->getRoot(), Eigen::Isometry3d::Identity(), nullptr, &links);
  if (links.empty()) {
    throw std::invalid_argument("scene: robot " + scene.model->getName() +
                                " has no collision geometry; expected at least one box, sphere, "
                                "cylinder or mesh");
  }
  return links;
}

std::vector<RigidObject> ReadSceneUrdf(const std::string& xml, const std::string& directory,
                                       const SurfaceDefaults& defaults) {
  std::vector<RigidObject> objects;
  for (SceneLink& link : ReadSceneLinks(xml, directory, defaults)) {
    objects.push_back(std::move(link.object));
  }
  return objects;
}

}  // namespace vacuum_gripper_sim
