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
  const std::string error = ErrorOf([&] { ReadSceneUrdf(xml); });
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
            "</link>"));
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

constexpr char kBall[] = "<collision><geometry><sphere radius=\"0.1\"/></geometry>";

/// A link of one sphere. @param friction Inside its collision element.
std::string Ball(const std::string& name, const std::string& friction = "",
                 const std::string& more = "") {
  return "<link name=\"" + name + "\">" + kBall + friction + "</collision>" + more + "</link>";
}

std::string Joint(const std::string& parent, const std::string& child, const std::string& type,
                  const std::string& origin = "0 0 0") {
  return "<joint name=\"" + parent + "_" + child + "\" type=\"" + type + "\"><parent link=\"" +
         parent + "\"/><child link=\"" + child + "\"/><origin xyz=\"" + origin + "\"/></joint>";
}

std::string Inertial(const std::string& mass, const std::string& ixx = "1e-3",
                     const std::string& origin = "xyz=\"0 0 0\"") {
  return "<inertial><origin " + origin + "/><mass value=\"" + mass + "\"/><inertia ixx=\"" + ixx +
         "\" ixy=\"0\" ixz=\"0\" iyy=\"2e-3\" iyz=\"0\" izz=\"2.5e-3\"/></inertial>";
}

TEST(SceneUrdf, FrictionOfTheElementThenOfGazeboThenTheDefault) {
  const std::string xml =
      Robot("<link name=\"table\">" + std::string(kBall) + "<friction mu=\"0.3\"/></collision>" +
            kBall + "</collision></link>" + Joint("table", "cloth", "fixed") + Ball("cloth") +
            "<gazebo reference=\"table\"><mu1>0.7</mu1><mu2>0.9</mu2></gazebo>");
  const std::vector<RigidObject> links = ReadSceneUrdf(xml, "", {0.2, 0.0});
  ASSERT_EQ(links.size(), 2U);
  EXPECT_EQ(links[0].surfaces[0].friction, 0.3);
  EXPECT_EQ(links[0].surfaces[1].friction, 0.7);
  EXPECT_EQ(links[1].surfaces[0].friction, 0.2);
}

TEST(SceneUrdf, RefusesFrictionThatIsNone) {
  for (const char* mu : {"mu=\"-0.5\"", "mu=\"rough\"", "mu=\"nan\"", "mu=\"inf\"", ""}) {
    const std::string error = Error(Robot(Ball("ball", "<friction " + std::string(mu) + "/>")));
    EXPECT_TRUE(Contains(error, "link ball: friction mu = ")) << mu << ": " << error;
  }
  EXPECT_TRUE(
      Contains(Error(Robot(Ball("ball") + "<gazebo reference=\"ball\"><mu1>-1</mu1></gazebo>")),
               "link ball: friction mu1 = -1"));
}

TEST(SceneUrdf, WhatAirFindsIsSaidInTheElement) {
  const std::string xml =
      Robot(Ball("crate",
                 "<air roughness=\"2.0e-6\" permeance=\"1.0e-9\"/><hole xyz=\"0.1 -0.2 0.3\" "
                 "area=\"1.0e-6\"/><hole xyz=\"0 0 0\" area=\"2.0e-6\"/>") +
            Joint("crate", "glass", "fixed") + Ball("glass"));
  const std::vector<RigidObject> links = ReadSceneUrdf(xml, "", {0.0, 5e-6});
  ASSERT_EQ(links.size(), 2U);
  const RigidSurface& crate = links[0].surfaces[0];
  EXPECT_EQ(crate.roughness, 2e-6);
  EXPECT_EQ(crate.permeance, 1e-9);
  ASSERT_EQ(crate.holes.size(), 2U);
  EXPECT_EQ(crate.holes[0].p_S, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(crate.holes[1].area, 2e-6);
  EXPECT_EQ(links[1].surfaces[0].roughness, 5e-6);
  EXPECT_TRUE(links[1].surfaces[0].holes.empty());

  const auto error = [](const std::string& air) { return Error(Robot(Ball("crate", air))); };
  EXPECT_TRUE(Contains(error("<air roughness=\"-1\"/>"), "link crate: air roughness = -1"));
  EXPECT_TRUE(Contains(error("<air permeance=\"x\"/>"), "link crate: air permeance = x"));
  EXPECT_TRUE(Contains(error("<hole xyz=\"0 0 0\"/>"), "link crate: hole area = nothing"));
  EXPECT_TRUE(Contains(error("<hole xyz=\"0 0\" area=\"1e-6\"/>"), "link crate: hole xyz = 0 0;"));
}

TEST(SceneUrdf, FloatingLinksAreFree) {
  // Inertia axes turned by 90 degrees of yaw: its x is the link's y.
  const std::vector<SceneLink> links = ReadSceneLinks(
      Robot(Ball("table") + Joint("table", "lid", "fixed", "0 0 1") + Ball("lid") +
            Joint("lid", "ball", "floating", "0 0.5 0") +
            Ball("ball", "",
                 Inertial("0.2", "1e-3", "xyz=\"0.01 0 0\" rpy=\"0 0 1.5707963267948966\""))),
      "", {});
  ASSERT_EQ(links.size(), 3U);
  EXPECT_FALSE(links[0].object.inertia || links[1].object.inertia);
  EXPECT_EQ(links[0].parent, "");
  const SceneLink& ball = links[2];
  EXPECT_EQ(ball.parent, "lid");
  EXPECT_TRUE(ball.X_PO.translation().isApprox(Eigen::Vector3d(0.0, 0.5, 0.0)));
  EXPECT_TRUE(ball.object.X_WO.translation().isApprox(Eigen::Vector3d(0.0, 0.5, 1.0)));
  ASSERT_TRUE(ball.object.inertia);
  EXPECT_EQ(ball.object.inertia->mass, 0.2);
  EXPECT_EQ(ball.object.inertia->p_OC, Eigen::Vector3d(0.01, 0.0, 0.0));
  EXPECT_TRUE(ball.object.inertia->about_C_O.isApprox(
      Eigen::Vector3d(2e-3, 1e-3, 2.5e-3).asDiagonal().toDenseMatrix(), 1e-9));
}

TEST(SceneUrdf, RefusesFreeLinksThatCannotMove) {
  const std::string above = Ball("table") + Joint("table", "ball", "floating");
  for (const auto& [link, part] : std::vector<std::pair<std::string, std::string>>{
           {Ball("ball"), "link ball: no inertial element"},
           {"<link name=\"ball\">" + Inertial("0.2") + "</link>",
            "link ball: no collision element"},
           {Ball("ball", "", Inertial("0")), "link ball: mass = 0"},
           {Ball("ball", "", Inertial("-0.1")), "link ball: mass = -0.1"},
           {Ball("ball", "", Inertial("nan")), "[ball]"},
           {Ball("ball", "", Inertial("heavy")), "heavy"},
           {Ball("ball", "", Inertial("0.2", "1e-4")), "link ball: inertia has the principal"},
           {Ball("ball", "", Inertial("0.2", "-1e-3")), "link ball: inertia has the principal"},
           {Ball("ball", "", Inertial("0.2")) + Joint("ball", "fin", "fixed") + Ball("fin"),
            "link fin: has collision geometry below the free link ball"}}) {
    const std::string error = Error(Robot(above + link));
    EXPECT_TRUE(Contains(error, "scene: ")) << error;
    EXPECT_TRUE(Contains(error, part)) << link << ": " << error;
  }
}

TEST(SceneUrdf, RefusesWhatIsNoTree) {
  EXPECT_TRUE(Contains(Error(Robot(Ball("ball") + Ball("ball"))), "link ball: there are two"));
  // urdfdom itself would leave a and b out without a word.
  EXPECT_TRUE(Contains(Error(Robot(Ball("table") + Ball("a") + Ball("b") +
                                   Joint("a", "b", "fixed") + Joint("b", "a", "fixed"))),
                       "a cycle"));
  const std::string two_parents = Error(Robot(Ball("a") + Ball("b") + Ball("c") +
                                              Joint("a", "c", "fixed") + Joint("b", "c", "fixed")));
  EXPECT_TRUE(Contains(two_parents, "link c: is the child of the joints a_c and b_c"))
      << two_parents;
}

TEST(SceneUrdf, RefusesASceneWithoutSurfaces) {
  EXPECT_TRUE(Contains(Error(Robot("<link name=\"empty\"/>")), "no collision geometry"));
}

}  // namespace
}  // namespace vacuum_gripper_sim
