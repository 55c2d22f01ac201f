#include "vacuum_gripper_sim/core/edge_ways.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "vacuum_gripper_sim/core/gmsh_reader.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kOpenGap = 1e-4;  // m

class EdgeWaysTest : public testing::Test {
 protected:
  const TetMesh mesh_ = ReadGmsh(VACUUM_GRIPPER_SOURCE_DIR "/meshes/bell_linear_700.msh");
  const CavitySurface surface_ = MakeCavitySurface(mesh_);
  const EdgeWays edge_ways_{surface_};

  /// Of the bell that stands on z = 0 at rest.
  std::vector<EdgeWay> Find(const DistanceToSurfaces& distance) const {
    std::vector<double> phi;
    for (const int node : surface_.nodes) phi.push_back(distance(mesh_.nodes.col(node)));
    return edge_ways_.Find(phi, kOpenGap, mesh_.nodes, distance);
  }
};

TEST_F(EdgeWaysTest, APlaneHasNone) {
  EXPECT_TRUE(Find([](const Eigen::Vector3d& p) { return p.z(); }).empty());
}

// A slot along y, 3 mm wide, under the middle of one of the lip's edges, which are 4.9 mm long.
TEST_F(EdgeWaysTest, ASlotBetweenTwoNodesIsSeen) {
  constexpr double kHalf = 0.0015;  // m
  std::vector<double> lowest;       // x of the lip's lowest nodes on the side of +y
  for (const int node : surface_.nodes) {
    if (mesh_.nodes(2, node) < 1e-9 && mesh_.nodes(1, node) > 0.0) {
      lowest.push_back(mesh_.nodes(0, node));
    }
  }
  std::sort(lowest.begin(), lowest.end());
  const double beside = 0.5 * (lowest[lowest.size() / 2] + lowest[lowest.size() / 2 - 1]);
  const auto distance = [&](const Eigen::Vector3d& p) {
    const double inside = std::max(0.0, kHalf - std::abs(p.x() - beside));
    return std::hypot(inside, p.z());
  };
  const std::vector<EdgeWay> ways = Find(distance);
  ASSERT_FALSE(ways.empty());
  for (const EdgeWay& way : ways) {
    const auto node = [&](int point) { return surface_.nodes[static_cast<std::size_t>(point)]; };
    const Eigen::Vector3d middle =
        0.5 * (mesh_.nodes.col(node(way.a)) + mesh_.nodes.col(node(way.b)));
    EXPECT_NEAR(middle.x(), beside, kHalf);
    EXPECT_NEAR(middle.head<2>().norm(), 0.01875, 5e-4);  // the lip's lowest circle
    EXPECT_NEAR(way.gap, kHalf, 0.1 * kHalf);
    const auto& neighbours = surface_.neighbours[static_cast<std::size_t>(way.from)];
    EXPECT_TRUE(std::binary_search(neighbours.begin(), neighbours.end(), way.a));
    EXPECT_TRUE(std::binary_search(neighbours.begin(), neighbours.end(), way.b));
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
