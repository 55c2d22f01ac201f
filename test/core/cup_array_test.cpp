#include "vacuum_gripper_sim/core/cup_array.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/gmsh_reader.h"

namespace vacuum_gripper_sim {
namespace {

TetMesh Bell() {
  return ReadGmsh(std::string(VACUUM_GRIPPER_SOURCE_DIR) + "/meshes/bell_linear_700.msh");
}

std::vector<CupMount> TwoMounts() {
  std::vector<CupMount> mounts(2);
  mounts[0].name = "left";
  mounts[0].X_MC.translation() << 0.03, -0.01, 0.002;
  mounts[1].name = "right";
  mounts[1].X_MC.translation() << -0.04, 0.02, 0.0;
  mounts[1].X_MC.linear() =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 0.5).normalized()).toRotationMatrix();
  return mounts;
}

TEST(CupArray, OfOneIsTheCupItself) {
  const TetMesh bell = Bell();
  const CupArray array = MakeCupArray(bell, {CupMount()});
  EXPECT_EQ(array.num_cups(), 1);
  EXPECT_EQ(array.mesh.nodes, bell.nodes);
  EXPECT_EQ(array.mesh.elements, bell.elements);
  EXPECT_EQ(array.nodes_per_cup, static_cast<int>(bell.nodes.cols()));
  EXPECT_LT((array.rest_M - MountFromRest(bell) * bell.nodes).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(CupArray, PutsEveryCupAtItsMount) {
  const TetMesh bell = Bell();
  const std::vector<CupMount> mounts = TwoMounts();
  const CupArray array = MakeCupArray(bell, mounts);
  const Eigen::Matrix3Xd rest_C = MountFromRest(bell) * bell.nodes;
  const int n = array.nodes_per_cup;
  ASSERT_EQ(array.rest_M.cols(), 2 * n);
  for (int cup = 0; cup < 2; ++cup) {
    const auto k = static_cast<std::size_t>(cup);
    EXPECT_EQ(array.FirstNode(k), cup * n);
    EXPECT_EQ(array.CupOfNode(cup * n), cup);
    EXPECT_EQ(array.CupOfNode(cup * n + n - 1), cup);
    EXPECT_LT((array.rest_M.middleCols(cup * n, n) - mounts[k].X_MC * rest_C).cwiseAbs().maxCoeff(),
              1e-14);
  }
}

TEST(CupArray, ItsSurfacesAreThoseOfTheCupOneAfterTheOther) {
  const TetMesh bell = Bell();
  const CupArray array = MakeCupArray(bell, TwoMounts());
  const CavitySurface one = MakeCavitySurface(bell);
  const int points = one.num_points();
  ASSERT_EQ(array.cavities.num_cups(), 2);
  EXPECT_EQ(array.cavities.first_points, (std::vector<int>{0, points, 2 * points}));
  for (int cup = 0; cup < 2; ++cup) {
    for (int i = 0; i < points; ++i) {
      const auto of_one = static_cast<std::size_t>(i);
      const auto of_array = static_cast<std::size_t>(cup * points + i);
      EXPECT_EQ(array.cavities.nodes[of_array], one.nodes[of_one] + cup * array.nodes_per_cup);
      ASSERT_EQ(array.cavities.neighbours[of_array].size(), one.neighbours[of_one].size());
      EXPECT_EQ(array.cavities.neighbours[of_array][0], one.neighbours[of_one][0] + cup * points);
    }
    const CavitySurface back = CavityOfCup(array.cavities, cup);
    EXPECT_EQ(back.triangles, one.triangles);
    EXPECT_EQ(back.border, one.border);
    EXPECT_EQ(back.port, one.port);
    EXPECT_EQ(back.neighbours, one.neighbours);
  }
}

TEST(CupArray, TheMountLooksDownTheAxis) {
  TetMesh bell = Bell();
  const Eigen::Isometry3d X_MR = MountFromRest(bell);
  const double top = bell.nodes.row(2).maxCoeff();
  EXPECT_LT(
      (X_MR * Eigen::Vector3d(0.001, 0.002, top - 0.003) - Eigen::Vector3d(0.001, -0.002, 0.003))
          .norm(),
      1e-15);
}

}  // namespace
}  // namespace vacuum_gripper_sim
