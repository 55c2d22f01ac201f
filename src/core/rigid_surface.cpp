#include "vacuum_gripper_sim/core/rigid_surface.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "vacuum_gripper_sim/core/triangle_mesh.h"

namespace vacuum_gripper_sim {
namespace {

/// Distance and normal in the surface's own frame S.
SurfaceDistance DistanceInFrame(const Plane&, const Eigen::Vector3d& p) {
  return {p.z(), Eigen::Vector3d::UnitZ()};
}

SurfaceDistance DistanceInFrame(const Sphere& sphere, const Eigen::Vector3d& p) {
  const double r = p.norm();
  return {r - sphere.radius, r > 0.0 ? Eigen::Vector3d(p / r) : Eigen::Vector3d::UnitZ()};
}

/** A convex solid that is the product of intervals: `excess` holds the signed distances to its
 faces along orthogonal directions, positive outside. Outside, the distance is the length of the
 positive part; inside, the face that is nearest counts. */
template <int N>
double ProductDistance(const Eigen::Matrix<double, N, 1>& excess,
                       Eigen::Matrix<double, N, 1>* direction) {
  const Eigen::Matrix<double, N, 1> outside = excess.cwiseMax(0.0);
  const double length = outside.norm();
  if (length > 0.0) {
    *direction = outside / length;
    return length;
  }
  Eigen::Index nearest = 0;
  const double depth = excess.maxCoeff(&nearest);
  *direction = Eigen::Matrix<double, N, 1>::Unit(nearest);
  return depth;
}

SurfaceDistance DistanceInFrame(const Box& box, const Eigen::Vector3d& p) {
  const Eigen::Vector3d sign = p.unaryExpr([](double x) { return x < 0.0 ? -1.0 : 1.0; });
  Eigen::Vector3d direction;
  const double distance = ProductDistance<3>(p.cwiseAbs() - 0.5 * box.size, &direction);
  return {distance, sign.cwiseProduct(direction)};
}

SurfaceDistance DistanceInFrame(const Cylinder& cylinder, const Eigen::Vector3d& p) {
  const double r = p.head<2>().norm();
  const Eigen::Vector3d radial =
      r > 0.0 ? Eigen::Vector3d(p.x() / r, p.y() / r, 0.0) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d axial = Eigen::Vector3d::UnitZ() * (p.z() < 0.0 ? -1.0 : 1.0);
  const Eigen::Vector2d excess(r - cylinder.radius, std::abs(p.z()) - 0.5 * cylinder.length);
  Eigen::Vector2d direction;
  const double distance = ProductDistance<2>(excess, &direction);
  return {distance, direction.x() * radial + direction.y() * axial};
}

SurfaceDistance DistanceInFrame(const Mesh& mesh, const Eigen::Vector3d& p) {
  const MeshPoint point = mesh->SeenFrom(1, *mesh->Nearest(p));
  return {point.distance, point.normal};
}

void RequirePositive(const std::string& name, const char* field, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  std::ostringstream message;
  message << "surface '" << name << "': " << field << " = " << value
          << ", must be finite and > 0 [m]";
  throw std::invalid_argument(message.str());
}

void ValidateShape(const std::string&, const Plane&) {}
void ValidateShape(const std::string& name, const Box& box) {
  RequirePositive(name, "size x", box.size.x());
  RequirePositive(name, "size y", box.size.y());
  RequirePositive(name, "size z", box.size.z());
}
void ValidateShape(const std::string& name, const Sphere& sphere) {
  RequirePositive(name, "radius", sphere.radius);
}
void ValidateShape(const std::string& name, const Cylinder& cylinder) {
  RequirePositive(name, "radius", cylinder.radius);
  RequirePositive(name, "length", cylinder.length);
}
void ValidateShape(const std::string& name, const Mesh& mesh) {
  if (mesh == nullptr) throw std::invalid_argument("surface '" + name + "': mesh is not set");
}

}  // namespace

SurfaceDistance Distance(const Shape& shape, const Eigen::Vector3d& p_S) {
  return std::visit([&](const auto& kind) { return DistanceInFrame(kind, p_S); }, shape);
}

SurfaceDistance Distance(const RigidSurface& surface, const Eigen::Vector3d& p_F) {
  const Eigen::Matrix3d R_FS = surface.X_FS.linear();
  const Eigen::Vector3d p_S = R_FS.transpose() * (p_F - surface.X_FS.translation());
  SurfaceDistance result = Distance(surface.shape, p_S);
  result.normal = R_FS * result.normal;
  return result;
}

bool IsRigidMotion(const Eigen::Isometry3d& X) {
  constexpr double kTolerance = 1e-6;
  const Eigen::Matrix3d R = X.linear();
  return X.matrix().allFinite() && R.determinant() > 0.0 &&
         (R.transpose() * R).isIdentity(kTolerance);
}

void Validate(const RigidSurface& surface) {
  std::visit([&](const auto& shape) { ValidateShape(surface.name, shape); }, surface.shape);
  const auto require_not_negative = [&](const std::string& field, double value, const char* unit) {
    if (std::isfinite(value) && value >= 0.0) return;
    std::ostringstream reason;
    reason << "surface '" << surface.name << "': " << field << " = " << value
           << ", must be finite and >= 0 " << unit;
    throw std::invalid_argument(reason.str());
  };
  require_not_negative("friction", surface.friction, "[-]");
  require_not_negative("roughness", surface.roughness, "[m]");
  require_not_negative("permeance", surface.permeance, "[m/(Pa s)]");
  for (std::size_t i = 0; i < surface.holes.size(); ++i) {
    const std::string field = "holes[" + std::to_string(i) + "]";
    require_not_negative(field + ".area", surface.holes[i].area, "[m^2]");
    if (surface.holes[i].p_S.allFinite()) continue;
    throw std::invalid_argument("surface '" + surface.name + "': " + field +
                                ".position is not finite, must be [m]");
  }
  if (IsRigidMotion(surface.X_FS)) return;
  std::ostringstream message;
  message << "surface '" << surface.name
          << "': pose is not a finite position with a rotation; translation = "
          << surface.X_FS.translation().transpose();
  throw std::invalid_argument(message.str());
}

}  // namespace vacuum_gripper_sim
