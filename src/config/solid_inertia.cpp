#include "solid_inertia.h"

namespace vacuum_gripper_sim {

std::optional<Eigen::Vector3d> SolidInertia(const Shape& shape, double mass) {
  if (const Box* box = std::get_if<Box>(&shape)) {
    const Eigen::Vector3d squares = box->size.cwiseAbs2();
    return mass / 12.0 * (Eigen::Vector3d::Constant(squares.sum()) - squares);
  }
  if (const Sphere* sphere = std::get_if<Sphere>(&shape)) {
    return Eigen::Vector3d::Constant(0.4 * mass * sphere->radius * sphere->radius);
  }
  if (const Cylinder* cylinder = std::get_if<Cylinder>(&shape)) {
    const double r2 = cylinder->radius * cylinder->radius;
    const double across = mass * (3.0 * r2 + cylinder->length * cylinder->length) / 12.0;
    return Eigen::Vector3d(across, across, 0.5 * mass * r2);
  }
  return std::nullopt;
}

}  // namespace vacuum_gripper_sim
