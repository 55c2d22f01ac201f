#include "vacuum_gripper_sim/core/pressure_on_objects.h"

#include <Eigen/Geometry>
#include <cstddef>

namespace vacuum_gripper_sim {

void PressureOnObjects(const Eigen::Matrix3Xd& load, const Eigen::Matrix3Xd& x_W,
                       const ContactFinder& finder, const RigidWorld& world,
                       std::vector<ObjectLoad>* loads) {
  loads->assign(world.objects().size(), ObjectLoad());
  if (world.surfaces().empty()) return;
  for (Eigen::Index node = 0; node < load.cols(); ++node) {
    if (load.col(node).isZero(0.0)) continue;
    const int nearest = finder.NearestSurface(static_cast<int>(node));
    const auto object = static_cast<std::size_t>(world.ObjectOf(nearest));
    const Eigen::Vector3d force_W = -load.col(node);
    const Eigen::Vector3d arm = x_W.col(node) - world.objects()[object].X_WO.translation();
    (*loads)[object].force_W += force_W;
    (*loads)[object].torque_W += arm.cross(force_W);
  }
}

}  // namespace vacuum_gripper_sim
