#include "vacuum_gripper_sim/core/misplacement.h"

#include <cstddef>
#include <sstream>

#include "vacuum_gripper_sim/core/body_contacts.h"

namespace vacuum_gripper_sim {
namespace {

/// Way of an object in one step, and depth in the cup or in another object, from which on it was
/// misplaced. [m]
constexpr double kDeep = 5e-3;

const std::string& NameOf(const RigidWorld& world, int surface) {
  return world.objects()[static_cast<std::size_t>(world.ObjectOf(surface))].name;
}

}  // namespace

std::string DescribeJump(const RigidWorld& world, const std::vector<int>& nodes,
                         const Eigen::Matrix3Xd& x_W) {
  double deepest = -kDeep;
  std::ostringstream message;
  for (std::size_t i = 0; i < world.surfaces().size(); ++i) {
    const auto surface = static_cast<int>(i);
    const int object = world.ObjectOf(surface);
    if (!world.WasPut(object)) continue;
    for (const int node : nodes) {
      const Eigen::Vector3d p_W = x_W.col(node);
      const double jump = world.Displacement(object, p_W, Eigen::VectorXd(), 0.0).norm();
      if (jump < kDeep) continue;
      const double distance = Distance(world.surfaces()[i], p_W).distance;
      if (distance > deepest) continue;
      deepest = distance;
      message.str({});
      message << "object '" << NameOf(world, surface) << "' was moved by " << jump
              << " m in one step, " << -deepest << " m into the cup; expected at most " << kDeep
              << " m";
    }
  }
  return message.str();
}

std::string DescribeOverlap(const RigidWorld& world) {
  BodyContacts contacts;
  contacts.Begin(world, -kDeep);
  double deepest = -kDeep;
  std::ostringstream message;
  for (const BodyContacts::Pair& pair : contacts.pairs()) {
    if (pair.seen.distance > deepest) continue;
    deepest = pair.seen.distance;
    const bool feels = world.BodyOf(world.ObjectOf(pair.feeling)) != RigidWorld::kNone;
    message.str({});
    message << "object '" << NameOf(world, feels ? pair.feeling : pair.surface) << "' was put "
            << -deepest << " m into object '" << NameOf(world, feels ? pair.surface : pair.feeling)
            << "'; expected at most " << kDeep << " m";
  }
  return message.str();
}

}  // namespace vacuum_gripper_sim
