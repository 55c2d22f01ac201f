#include "vacuum_gripper_sim/config/scene_urdf.h"

#include <gtest/gtest.h>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

std::string Robot(const std::string& inside) {
  return "<?xml version=\"1.0\"?><robot name=\"scene\">" + inside + "</robot>";
}

std::string Link(const std::string& name, const std::string& geometry) {
  return "<link name=\"" + name + "\"><collision><geometry>" + geometry +
         "</geometry></collision></link>";
}

std::string Error(const std::string& xml) {
  testing::internal::CaptureStderr();
  const std::string error = ErrorOf([&] { ReadSceneUrdf(xml, 0.0); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "the parser's own words must not show";
  return error;
}

TEST(SceneUrdf, ReadsShapesAndPoses) {
  const std::vector<RigidObject> links = ReadSceneUrdf(
      Robot("<link name=\"world\"/>"
            "<joint name=\"j\" type=\"fixed\"><parent link=\"world\"/><child link=\"table\"/>"
            "<origin xyz=\"0 0 0.5\" rpy=\"0 0 1.5707963267948966\"/></joint>"
            "<link name=\"table\">"
            "<collision><origin xyz=\"0.1 0 0\" rpy=\"0 1.5707963267948966 0\"/>"
            "<geometry><box size=\"1 2 3\"/></geometry></collision>"
            "<collision><geometry><sphere radius=\"0.25\"/></geometry></collision>"
            "<collision><geometry><cylinder radius=\"0.5\" length=\"2\"/></geometry></collision>"
            "</link>"),
      0.0);
  ASSERT_EQ(links.size(), 1U);  // the world has no surface
  const RigidObject& table = links[0];
  EXPECT_EQ(table.name, "table");
  ASSERT_EQ(table.surfaces.size(), 3U);
  EXPECT_EQ(std::get<Box>(table.surfaces[0].shape).size, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(std::get<Sphere>(table.surfaces[1].shape).radius, 0.25);
  EXPECT_EQ(std::get<Cylinder>(table.surfaces[2].shape).radius, 0.5);
  EXPECT_EQ(std::get<Cylinder>(table.surfaces[2].shape).length, 2.0);
  // Pitch of 90 degrees takes the box's x to -z of the link.
  EXPECT_TRUE((table.surfaces[0].X_FS * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d(0.1, 0.0, -1.0), 1e-12));
  // The joint lifts the link and turns its x to y of the root.
  EXPECT_TRUE((table.X_WO * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(0, 1, 0.5), 1e-12));
}

TEST(SceneUrdf, RefusesWhatIsNoUrdf) {
  for (const char* xml : {"", "hello", "<sdf/>", "<robot name=\"x\">", "<robot name=\"x\"/>"}) {
    EXPECT_TRUE(Contains(Error(xml), "scene: not a valid URDF")) << xml << ": " << Error(xml);
  }
}

TEST(SceneUrdf, RefusesBadGeometryAndNamesTheLink) {
  EXPECT_TRUE(Contains(Error(Robot(Link("bowl", "<mesh filename=\"bowl.stl\"/>"))), "link bowl"));
  EXPECT_TRUE(Contains(Error(Robot(Link("ball", "<sphere radius=\"0\"/>"))), "link ball"));
  EXPECT_TRUE(Contains(Error(Robot(Link("ball", "<sphere radius=\"-1\"/>"))), "link ball"));
  EXPECT_TRUE(Contains(Error(Robot(Link("brick", "<box size=\"1 0 1\"/>"))), "link brick"));
  for (const char* geometry : {"<box size=\"1 nan 1\"/>", "<box size=\"1 1\"/>",
                               "<sphere radius=\"wide\"/>", "<cone radius=\"1\"/>", ""}) {
    EXPECT_TRUE(Contains(Error(Robot(Link("thing", geometry))), "scene: ")) << geometry;
  }
}

TEST(SceneUrdf, RefusesASceneWithoutSurfaces) {
  EXPECT_TRUE(Contains(Error(Robot("<link name=\"empty\"/>")), "no collision geometry"));
}

}  // namespace
}  // namespace vacuum_gripper_sim
