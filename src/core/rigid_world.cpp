#include "vacuum_gripper_sim/core/rigid_world.h"

#include <sstream>
#include <stdexcept>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d Rotation(const Vector3d& angle) {
  const double size = angle.norm();
  if (size == 0.0) return Matrix3d::Identity();
  return Eigen::AngleAxisd(size, angle / size).toRotationMatrix();
}

}  // namespace

void RigidWorld::SetObjects(std::vector<RigidObject> objects) {
  for (const RigidObject& object : objects) Validate(object);
  objects_ = std::move(objects);
  X_WO_before_.clear();
  surfaces_.clear();
  object_of_.clear();
  first_surface_.clear();
  body_of_.clear();
  bodies_.clear();
  for (const RigidObject& object : objects_) {
    const auto index = static_cast<int>(first_surface_.size());
    X_WO_before_.push_back(object.X_WO);
    first_surface_.push_back(static_cast<int>(surfaces_.size()));
    body_of_.push_back(object.inertia ? num_bodies() : kNone);
    if (object.inertia) {
      Body body;
      body.object = index;
      const Vector3d OC_W = object.X_WO.linear() * object.inertia->p_OC;
      body.V.head<3>() = object.velocity_W;
      body.V.head<3>() += object.angular_velocity_W.cross(OC_W);
      body.V.tail<3>() = object.angular_velocity_W;
      bodies_.push_back(body);
    }
    surfaces_.insert(surfaces_.end(), object.surfaces.begin(), object.surfaces.end());
    object_of_.insert(object_of_.end(), object.surfaces.size(), index);
    Place(index, object.X_WO, &surfaces_);
  }
}

void RigidWorld::SetPose(int object, const Isometry3d& X_WO) {
  RigidObject& moved = objects_.at(static_cast<std::size_t>(object));
  if (!IsRigidMotion(X_WO)) {
    std::ostringstream reason;
    reason << "object '" << moved.name
           << "': pose is not a finite position with a rotation; translation = "
           << X_WO.translation().transpose();
    throw std::invalid_argument(reason.str());
  }
  moved.X_WO = X_WO;
  Place(object, X_WO, &surfaces_);
  if (BodyOf(object) == kNone) return;
  bodies_[static_cast<std::size_t>(BodyOf(object))].V.setZero();
  X_WO_before_[static_cast<std::size_t>(object)] = X_WO;
}

void RigidWorld::Place(int object, const Isometry3d& X_WO,
                       std::vector<RigidSurface>* surfaces) const {
  const RigidObject& placed = objects_[static_cast<std::size_t>(object)];
  const auto first = static_cast<std::size_t>(first_surface_[static_cast<std::size_t>(object)]);
  for (std::size_t i = 0; i < placed.surfaces.size(); ++i) {
    (*surfaces)[first + i].X_FS = X_WO * placed.surfaces[i].X_FS;
  }
}

RigidWorld::Vector6d RigidWorld::velocity(int body) const {
  return bodies_[static_cast<std::size_t>(body)].V;
}

Vector3d RigidWorld::CentreOfMass(int body) const {
  const RigidObject& object =
      objects_[static_cast<std::size_t>(bodies_[static_cast<std::size_t>(body)].object)];
  return object.X_WO * object.inertia->p_OC;
}

Eigen::Matrix<double, 6, 6> RigidWorld::Mass(int body) const {
  const RigidObject& object =
      objects_[static_cast<std::size_t>(bodies_[static_cast<std::size_t>(body)].object)];
  const Matrix3d R_WO = object.X_WO.linear();
  Eigen::Matrix<double, 6, 6> M = Eigen::Matrix<double, 6, 6>::Zero();
  M.topLeftCorner<3, 3>() = object.inertia->mass * Matrix3d::Identity();
  M.bottomRightCorner<3, 3>() = R_WO * object.inertia->about_C_O * R_WO.transpose();
  return M;
}

void RigidWorld::FreeImpulse(const Vector3d& gravity, double h, Eigen::VectorXd* b) const {
  b->resize(6 * num_bodies());
  for (int body = 0; body < num_bodies(); ++body) {
    const Eigen::Matrix<double, 6, 6> M = Mass(body);
    const Vector3d omega = velocity(body).tail<3>();
    b->segment<3>(6 * body) = h * M(0, 0) * gravity;
    b->segment<3>(6 * body + 3) = -h * omega.cross(M.bottomRightCorner<3, 3>() * omega);
  }
}

Isometry3d RigidWorld::PoseAfter(int object, const Eigen::VectorXd& dV, double h) const {
  const RigidObject& moving = objects_[static_cast<std::size_t>(object)];
  const int body = BodyOf(object);
  if (body == kNone) return moving.X_WO;
  const Vector6d motion = h * (velocity(body) + dV.segment<6>(6 * body));
  const Vector3d c_W = CentreOfMass(body) + motion.head<3>();
  Isometry3d X_WO = Isometry3d::Identity();
  X_WO.linear() = Rotation(motion.tail<3>()) * moving.X_WO.linear();
  X_WO.translation() = c_W - X_WO.linear() * moving.inertia->p_OC;
  return X_WO;
}

void RigidWorld::SurfacesAfter(const Eigen::VectorXd& dV, double h,
                               std::vector<RigidSurface>* surfaces) const {
  *surfaces = surfaces_;
  for (const Body& body : bodies_) {
    Place(body.object, PoseAfter(body.object, dV, h), surfaces);
  }
}

Vector3d RigidWorld::Displacement(int object, const Vector3d& p_W, const Eigen::VectorXd& dV,
                                  double h) const {
  const Isometry3d& X_WO = objects_[static_cast<std::size_t>(object)].X_WO;
  if (BodyOf(object) != kNone) return PoseAfter(object, dV, h) * (X_WO.inverse() * p_W) - p_W;
  const Isometry3d& X_WO_before = X_WO_before_[static_cast<std::size_t>(object)];
  return p_W - X_WO_before * (X_WO.inverse() * p_W);
}

Vector3d RigidWorld::FreeDisplacement(int object, const Vector3d& p_W, const Eigen::VectorXd& dV,
                                      double h) const {
  if (BodyOf(object) == kNone) return Vector3d::Zero();
  return Displacement(object, p_W, dV, h);
}

bool RigidWorld::WasPut(int object) const {
  const auto i = static_cast<std::size_t>(object);
  return BodyOf(object) == kNone && objects_[i].X_WO.matrix() != X_WO_before_[i].matrix();
}

bool RigidWorld::AnyMoves() const {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (WasPut(static_cast<int>(i))) return true;
  }
  return num_bodies() > 0;
}

void RigidWorld::Advance(const Eigen::VectorXd& dV, double h) {
  for (int i = 0; i < num_bodies(); ++i) {
    Body& body = bodies_[static_cast<std::size_t>(i)];
    const Isometry3d X_WO = PoseAfter(body.object, dV, h);
    body.V += dV.segment<6>(6 * i);
    // Products of many rotations drift away from one.
    RigidObject& object = objects_[static_cast<std::size_t>(body.object)];
    object.X_WO = X_WO;
    object.X_WO.linear() = Eigen::Quaterniond(X_WO.linear()).normalized().toRotationMatrix();
    Place(body.object, object.X_WO, &surfaces_);
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) X_WO_before_[i] = objects_[i].X_WO;
}

}  // namespace vacuum_gripper_sim
