#include "vacuum_gripper_sim/core/seal_tolerance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "vacuum_gripper_sim/core/gmsh_reader.h"

namespace vacuum_gripper_sim {
namespace {

/// A strip of triangles, bent about the x axis: points on a circle through (x, 0, 0) at `angle`s,
/// wound so that area vectors point to the circle's centre (a convex lip) or away from it.
struct Strip {
  CavitySurface cavity;
  Eigen::Matrix3Xd points;

  Strip(double radius, double step, bool convex) {
    constexpr int kRows = 9;
    points.resize(3, 2 * kRows);
    cavity.triangles.resize(3, 2 * (kRows - 1));
    cavity.neighbours.resize(2 * kRows);
    for (int i = 0; i < kRows; ++i) {
      const double angle = step * i;
      for (int side = 0; side < 2; ++side) {
        points.col(2 * i + side) << 0.001 * side, radius * std::cos(angle),
            radius * std::sin(angle);
        cavity.nodes.push_back(2 * i + side);
      }
      if (i == 0) continue;
      const int a = 2 * i - 2;
      const int b = a + 1;
      const int c = a + 2;
      const int d = a + 3;
      cavity.triangles.col(a) = convex ? Eigen::Vector3i(a, b, c) : Eigen::Vector3i(a, c, b);
      cavity.triangles.col(b) = convex ? Eigen::Vector3i(b, d, c) : Eigen::Vector3i(b, c, d);
      for (const auto& [p, q] : {std::pair(a, c), std::pair(b, d)}) {
        cavity.neighbours[static_cast<std::size_t>(p)].push_back(q);
        cavity.neighbours[static_cast<std::size_t>(q)].push_back(p);
      }
    }
  }
};

TEST(LipSagitta, IsThatOfACircle) {
  constexpr double kRadius = 0.00125;
  for (const double step : {0.1, 0.2, 0.4}) {
    const Strip strip(kRadius, step, true);
    const double exact = kRadius * (1.0 - std::cos(0.5 * step));
    EXPECT_NEAR(LipSagitta(strip.cavity, strip.points), exact, 0.03 * exact) << step;
  }
}

TEST(LipSagitta, ConcaveAndFlatSurfacesHaveNone) {
  const Strip concave(0.00125, 0.2, false);
  EXPECT_EQ(LipSagitta(concave.cavity, concave.points), 0.0);
  const Strip flat(1e6, 1e-9, true);
  EXPECT_LT(LipSagitta(flat.cavity, flat.points), 1e-9);
}

TEST(LipSagitta, ShrinksAsTheSquareOfTheMesh) {
  const auto of = [](const std::string& name) {
    const TetMesh mesh =
        ReadGmsh(std::string(VACUUM_GRIPPER_SOURCE_DIR) + "/meshes/bell_" + name + ".msh");
    return LipSagitta(MakeCavitySurface(mesh), mesh.nodes);
  };
  // Mid-edge nodes halve the edges.
  EXPECT_NEAR(of("linear_700") / of("quadratic_700"), 4.0, 1.5);
  EXPECT_NEAR(of("linear_3000") / of("quadratic_3000"), 4.0, 1.5);
  EXPECT_GT(of("linear_700"), of("linear_3000"));
  EXPECT_GT(of("linear_3000"), of("linear_10000"));
}

TEST(ResolveSealGaps, KeepsWhatIsGivenAndTheOrder) {
  const auto resolve = [](std::optional<double> close, std::optional<double> open, double sagitta) {
    SealParameters seal;
    seal.close_gap = close;
    seal.open_gap = open;
    seal = ResolveSealGaps(seal, sagitta);
    return std::pair(*seal.close_gap, *seal.open_gap);
  };
  EXPECT_EQ(resolve({}, {}, 5e-5), std::pair(5e-5, 5e-5));
  EXPECT_EQ(resolve({}, {}, 0.0), std::pair(kFinestSealGap, kFinestSealGap));
  EXPECT_EQ(resolve(1e-4, 2e-4, 5e-5), std::pair(1e-4, 2e-4));
  EXPECT_EQ(resolve(1e-4, {}, 5e-5), std::pair(1e-4, 1e-4));
  EXPECT_EQ(resolve(2e-5, {}, 5e-5), std::pair(2e-5, 5e-5));
  EXPECT_EQ(resolve({}, 2e-5, 5e-5), std::pair(2e-5, 2e-5));
  EXPECT_EQ(resolve({}, 2e-4, 5e-5), std::pair(5e-5, 2e-4));
}

}  // namespace
}  // namespace vacuum_gripper_sim
