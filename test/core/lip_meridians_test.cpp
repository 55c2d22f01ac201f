#include "vacuum_gripper_sim/core/lip_meridians.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/mesh_test_tools.h"
#include "vacuum_gripper_sim/core/gmsh_reader.h"

namespace vacuum_gripper_sim {
namespace {

class LipMeridiansTest : public testing::TestWithParam<const char*> {
 protected:
  Eigen::Vector3d Position(const LipMeridians::Crossing& at) const {
    return (1.0 - at.t) * mesh_.nodes.col(surface_.nodes[static_cast<std::size_t>(at.a)]) +
           at.t * mesh_.nodes.col(surface_.nodes[static_cast<std::size_t>(at.b)]);
  }
  const TetMesh mesh_ =
      ReadGmsh(VACUUM_GRIPPER_SOURCE_DIR "/meshes/" + std::string(GetParam()) + ".msh");
  const CavitySurface surface_ = MakeCavitySurface(mesh_);
  const LipMeridians meridians_ = MakeLipMeridians(surface_, mesh_.nodes);
};

TEST_P(LipMeridiansTest, LeadFromThePortToTheBorder) {
  const auto is_border = [&](int point) {
    return std::binary_search(surface_.border.begin(), surface_.border.end(), point);
  };
  ASSERT_EQ(meridians_.chains.size(), static_cast<std::size_t>(LipMeridians::kNumber));
  EXPECT_EQ(meridians_.chains.back().end, static_cast<int>(meridians_.crossings.size()));
  double longest = 0.0, shortest = 1.0;
  for (int k = 0; k < LipMeridians::kNumber; ++k) {
    const LipMeridians::Chain& chain = meridians_.chains[static_cast<std::size_t>(k)];
    const auto begin = static_cast<std::size_t>(chain.begin);
    const auto end = static_cast<std::size_t>(chain.end);
    ASSERT_GE(end - begin, 3u);
    const double port = Position(meridians_.crossings[begin]).head<2>().norm();
    EXPECT_GE(port, 0.25 * meridians_.radius);
    EXPECT_LE(port, 0.75 * meridians_.radius);  // less than an edge further out
    const LipMeridians::Crossing& last = meridians_.crossings[end - 1];
    EXPECT_TRUE(is_border(last.a) && is_border(last.b));
    double length = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const LipMeridians::Crossing& at = meridians_.crossings[i];
      EXPECT_GE(at.t, 0.0);
      EXPECT_LE(at.t, 1.0);
      const auto& neighbours = surface_.neighbours[static_cast<std::size_t>(at.a)];
      EXPECT_TRUE(std::binary_search(neighbours.begin(), neighbours.end(), at.b));
      const Eigen::Vector3d p = Position(at);
      const double azimuth = std::atan2(-p.y(), p.x());
      EXPECT_NEAR(std::remainder(azimuth - LipMeridians::Azimuth(k), 2.0 * M_PI), 0.0, 1e-9);
      if (i > begin) length += (p - Position(meridians_.crossings[i - 1])).norm();
    }
    longest = std::max(longest, length);
    shortest = std::min(shortest, length);
  }
  EXPECT_GT(shortest, 0.6 * longest);  // none is cut short
}

// The cup is round: what is opposite is a step of the azimuth away.
TEST_P(LipMeridiansTest, KnowThePlaceBesideEachCrossing) {
  for (int k = 0; k < LipMeridians::kNumber; ++k) {
    const LipMeridians::Chain& chain = meridians_.chains[static_cast<std::size_t>(k)];
    const int next = (k + 1) % LipMeridians::kNumber;
    const LipMeridians::Chain& beside = meridians_.chains[static_cast<std::size_t>(next)];
    for (int i = chain.begin; i < chain.end; ++i) {
      const auto& at = meridians_.crossings[static_cast<std::size_t>(i)];
      ASSERT_GE(at.beside, beside.inner);
      ASSERT_LT(at.beside + 1, beside.end);
      const Eigen::Vector3d here = Position(at);
      const Eigen::Vector3d there =
          (1.0 - at.beside_t) *
              Position(meridians_.crossings[static_cast<std::size_t>(at.beside)]) +
          at.beside_t * Position(meridians_.crossings[static_cast<std::size_t>(at.beside) + 1]);
      const double step = 2.0 * M_PI / LipMeridians::kNumber * here.head<2>().norm();
      EXPECT_NEAR((there - here).norm(), step, 0.15 * step) << k << ", " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, LipMeridiansTest,
                         testing::Values("bell_linear_700", "bell_quadratic_700",
                                         "bell_linear_3000", "bell_quadratic_3000",
                                         "bell_linear_10000", "flat_linear_700",
                                         "flat_quadratic_700", "bellows_linear_1600",
                                         "bellows_quadratic_1600"),
                         [](const auto& info) { return std::string(info.param); });

TEST(LipMeridians, RefusesASurfaceBesideItsAxis) {
  TetMesh mesh = ReadGmsh(VACUUM_GRIPPER_SOURCE_DIR "/meshes/bell_linear_700.msh");
  const CavitySurface surface = MakeCavitySurface(mesh);
  mesh.nodes.row(0).array() += 0.05;
  ExpectInvalid([&] { MakeLipMeridians(surface, mesh.nodes); }, {"cavity surface", "axis"});
}

}  // namespace
}  // namespace vacuum_gripper_sim
