#include "vacuum_gripper_sim/config/cup_list.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

std::vector<CupMount> Read(const std::string& yaml) {
  return ReadCupMounts(YAML::Load(yaml), "cups");
}

TEST(CupList, PlacesCupsInTheGrippersMount) {
  const std::vector<CupMount> cups = Read(R"(
- {name: left, position: [0.03, -0.02, 0.01]}
- name: Right_2
  position: [0.0, 0.0, 0.0]
  orientation: [0.0, 0.7071067811865476, 0.0, 0.7071067811865476]
)");
  ASSERT_EQ(cups.size(), 2U);
  EXPECT_EQ(cups[0].name, "left");
  EXPECT_EQ(cups[0].X_MC.translation(), Eigen::Vector3d(0.03, -0.02, 0.01));
  EXPECT_TRUE(cups[0].X_MC.linear().isIdentity(0.0));
  EXPECT_EQ(cups[1].name, "Right_2");
  // A quarter of a turn about y takes its axis to x.
  EXPECT_LT((cups[1].X_MC.linear().col(2) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

TEST(CupList, RefusalsNameTheCup) {
  const auto error = [](const std::string& yaml) { return ErrorOf([&] { Read(yaml); }); };
  EXPECT_TRUE(Contains(error("{name: a}"), "cups = {name: a}; expected a list"));
  EXPECT_TRUE(Contains(error("[]"), "cups = []; expected a list of one cup or more"));
  EXPECT_TRUE(Contains(error("[{position: [0, 0, 0]}]"), "cups.0.name is not set"));
  EXPECT_TRUE(Contains(error("[{name: a}]"), "cups.0.position is not set"));
  EXPECT_TRUE(Contains(error("[a]"), "cups.0 = a; expected a map"));
  EXPECT_TRUE(Contains(error("[{name: a, position: [0, 0, 0], rotation: [0, 0, 0]}]"),
                       "cups.0.rotation is not a known key"));
  EXPECT_TRUE(Contains(error("[{name: a, position: [0, 0, 0], orientation: [0, 0, 0, 2]}]"),
                       "cups.0.orientation = [0, 0, 0, 2]"));
  for (const std::string name : {"2nd", "_a", "a/b", "a b", "a-b", "''"}) {
    EXPECT_TRUE(Contains(error("[{name: " + name + ", position: [0, 0, 0]}]"),
                         "expected a letter, then letters, digits and underscores"))
        << name;
  }
  EXPECT_TRUE(Contains(error("[{name: a, position: [0, 0, 0]}, {name: a, position: [0.1, 0, 0]}]"),
                       "cups.1.name = 'a' is another cup's"));
}

}  // namespace
}  // namespace vacuum_gripper_sim
