#include "vacuum_gripper_sim/config/scene_urdf.h"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <exception>
#include <stdexcept>
#include <utility>

#include "vacuum_gripper_sim/config/mesh_file.h"

namespace vacuum_gripper_sim {
namespace {

/// Keeps urdfdom's first complaint instead of printing it: the reason belongs into our one line.
class ComplaintCatcher : public console_bridge::OutputHandler {
 public:
  ComplaintCatcher() { console_bridge::useOutputHandler(this); }
  ~ComplaintCatcher() override { console_bridge::restorePreviousOutputHandler(); }
  ComplaintCatcher(const ComplaintCatcher&) = delete;
  ComplaintCatcher& operator=(const ComplaintCatcher&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    if (complaint_.empty() && level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) complaint_ = text;
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
  if (model == nullptr) {
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

std::vector<RigidSurface> ReadSurfaces(const urdf::Link& link, MeshFiles* meshes) {
  std::vector<RigidSurface> surfaces;
  for (const urdf::CollisionSharedPtr& collision : link.collision_array) {
    if (collision == nullptr || collision->geometry == nullptr) {
      throw std::invalid_argument("scene: link " + link.name +
                                  ": a collision element without geometry; expected box, sphere, "
                                  "cylinder or mesh");
    }
    RigidSurface surface;
    surface.name = link.name;
    surface.shape = ToShape(*collision->geometry, link.name, meshes);
    surface.X_FS = ToIsometry(collision->origin);
    try {
      Validate(surface);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument("scene: link " + link.name + ": " + e.what());
    }
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

/// Depth first from the root, so that parents come before their children.
void Collect(const urdf::Link& link, const Eigen::Isometry3d& X_RL, MeshFiles* meshes,
             std::vector<RigidObject>* objects) {
  RigidObject object;
  object.name = link.name;
  object.surfaces = ReadSurfaces(link, meshes);
  object.X_WO = X_RL;
  if (!object.surfaces.empty()) objects->push_back(std::move(object));
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    Collect(*child, X_RL * ToIsometry(child->parent_joint->parent_to_joint_origin_transform),
            meshes, objects);
  }
}

}  // namespace

std::vector<RigidObject> ReadSceneUrdf(const std::string& xml, const std::string& directory) {
  const urdf::ModelInterfaceSharedPtr model = Parse(xml);
  MeshFiles meshes(directory);
  std::vector<RigidObject> objects;
  Collect(*model->getRoot(), Eigen::Isometry3d::Identity(), &meshes, &objects);
  if (objects.empty()) {
    throw std::invalid_argument("scene: robot " + model->getName() +
                                " has no collision geometry; expected at least one box, sphere, "
                                "cylinder or mesh");
  }
  return objects;
}

}  // namespace vacuum_gripper_sim
