#include "vacuum_gripper_sim/core/misplacement.h"

#include <gtest/gtest.h>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

RigidObject BoxAt(const std::string& name, const Vector3d& position, bool free) {
  RigidObject box = FixedObject(RigidSurface{name, Box{{0.1, 0.1, 0.1}}});
  box.X_WO.translation() = position;
  if (free) {
    box.inertia = RigidInertia();
    box.inertia->mass = 0.2;
  }
  return box;
}

Eigen::Isometry3d At(const Vector3d& position, double angle) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = position;
  X.linear() = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
  return X;
}

// Of two objects that moved the one that is in the cup is named, not the one that moved farthest.
TEST(Misplacement, NamesTheObjectInTheCup) {
  RigidWorld world;
  world.SetObjects({BoxAt("far", {1.0, 0.0, 0.0}, false), BoxAt("near", {0.2, 0.0, 0.0}, false)});
  const Eigen::Matrix3Xd x_W = Eigen::Matrix3Xd::Zero(3, 2);
  world.SetPose(0, At({3.0, 0.0, 0.0}, 0.0));
  EXPECT_EQ(DescribeJump(world, {0, 1}, x_W), "");
  world.SetPose(1, At({0.04, 0.0, 0.0}, 0.0));
  const std::string message = DescribeJump(world, {0, 1}, x_W);
  EXPECT_NE(message.find("'near' was moved by 0.16 m"), std::string::npos) << message;
  EXPECT_NE(message.find("0.01 m into the cup"), std::string::npos) << message;
  world.Advance({}, 0.01);  // it is no news any more
  EXPECT_EQ(DescribeJump(world, {0, 1}, x_W), "");
}

// A long object that turns moves, too, though its origin stays.
TEST(Misplacement, TurningIsMoving) {
  RigidObject door = BoxAt("door", Vector3d::Zero(), false);
  door.surfaces[0].X_FS.translation().x() = 0.3;
  RigidWorld world;
  world.SetObjects({door});
  Eigen::Matrix3Xd x_W(3, 1);
  x_W.col(0) << 0.0, 0.3, 0.0;
  EXPECT_EQ(DescribeJump(world, {0}, x_W), "");
  world.SetPose(0, At(Vector3d::Zero(), 0.5 * M_PI));
  EXPECT_NE(DescribeJump(world, {0}, x_W).find("'door'"), std::string::npos);
}

TEST(Misplacement, NamesTheFreeObjectAndWhatItIsIn) {
  RigidWorld world;
  for (const bool free_first : {false, true}) {
    std::vector<RigidObject> objects{BoxAt("table", Vector3d::Zero(), false),
                                     BoxAt("part", {0.02, 0.03, 0.09}, true)};
    if (free_first) std::swap(objects[0], objects[1]);
    world.SetObjects(objects);
    const std::string message = DescribeOverlap(world);
    EXPECT_NE(message.find("'part' was put 0.01 m into object 'table'"), std::string::npos)
        << message;
  }
  world.SetObjects(
      {BoxAt("table", Vector3d::Zero(), false), BoxAt("part", {0.02, 0.03, 0.096}, true)});
  EXPECT_EQ(DescribeOverlap(world), "");  // contact answers 4 mm
  world.SetObjects(
      {BoxAt("table", Vector3d::Zero(), false), BoxAt("shelf", {0.02, 0.03, 0.09}, false)});
  EXPECT_EQ(DescribeOverlap(world), "");  // nobody moves
}

}  // namespace
}  // namespace vacuum_gripper_sim
