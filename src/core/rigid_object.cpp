#include "vacuum_gripper_sim/core/rigid_object.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <variant>

namespace vacuum_gripper_sim {
namespace {

/// Principal moments are computed: a rod's may break the triangle inequality by rounding.
constexpr double kSlack = 1e-6;

[[noreturn]] void Refuse(const std::string& object, const std::string& reason) {
  throw std::invalid_argument("object '" + object + "': " + reason);
}

void ValidateInertia(const std::string& object, const RigidInertia& inertia) {
  std::ostringstream reason;
  if (!(std::isfinite(inertia.mass) && inertia.mass > 0.0)) {
    reason << "mass = " << inertia.mass << ", must be finite and > 0 [kg]";
    Refuse(object, reason.str());
  }
  if (!inertia.p_OC.allFinite()) {
    reason << "centre of mass = " << inertia.p_OC.transpose() << ", must be finite [m]";
    Refuse(object, reason.str());
  }
  const Eigen::Matrix3d& I = inertia.about_C_O;
  const bool symmetric = I.allFinite() && (I - I.transpose()).norm() <= kSlack * I.norm();
  if (!symmetric) Refuse(object, "inertia is not a finite symmetric matrix [kg m^2]");
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(I).eigenvalues();
  const bool is_of_a_body =
      moments(0) > 0.0 && moments(2) <= (moments(0) + moments(1)) * (1.0 + kSlack);
  if (is_of_a_body) return;
  reason << "inertia has the principal moments " << moments.transpose()
         << ", must be > 0 and none larger than the sum of the others [kg m^2]";
  Refuse(object, reason.str());
}

}  // namespace

RigidObject FixedObject(RigidSurface surface) {
  RigidObject object;
  object.name = surface.name;
  object.surfaces.push_back(std::move(surface));
  return object;
}

void Validate(const RigidObject& object) {
  if (object.surfaces.empty()) Refuse(object.name, "has no surface, must have at least one");
  for (const RigidSurface& surface : object.surfaces) Validate(surface);
  if (!IsRigidMotion(object.X_WO)) {
    std::ostringstream reason;
    reason << "pose is not a finite position with a rotation; translation = "
           << object.X_WO.translation().transpose();
    Refuse(object.name, reason.str());
  }
  if (!object.velocity_W.allFinite() || !object.angular_velocity_W.allFinite()) {
    std::ostringstream reason;
    reason << "velocity = " << object.velocity_W.transpose()
           << ", angular velocity = " << object.angular_velocity_W.transpose()
           << ", must be finite [m/s], [rad/s]";
    Refuse(object.name, reason.str());
  }
  if (!object.inertia) return;
  ValidateInertia(object.name, *object.inertia);
  for (const RigidSurface& surface : object.surfaces) {
    if (!std::holds_alternative<Plane>(surface.shape)) continue;
    Refuse(object.name, "surface '" + surface.name +
                            "' of a free object is a plane, which has no end; must be a box, "
                            "sphere, cylinder or mesh");
  }
}

}  // namespace vacuum_gripper_sim
