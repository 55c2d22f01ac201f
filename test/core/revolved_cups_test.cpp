// The meshes of flat pad and bellows against their profiles, config/cups/profiles/flat_700.yaml and
// bellows_1600.yaml.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "support/mesh_volume.h"
#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/gmsh_reader.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Outline = std::vector<Vector2d>;  // (r, z), from the axis to the axis, the cavity first [m]

/// Points on a circle from one angle to another. [rad]
void AppendArc(Outline* outline, const Vector2d& centre, double radius, double from, double to) {
  constexpr int kPoints = 1000;
  for (int k = 0; k <= kPoints; ++k) {
    const double angle = from + (to - from) * k / kPoints;
    outline->push_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
}

/// Of the solid of revolution: pi times the integral of r^2 dz round the section. [m^3]
double RevolvedVolume(const Outline& outline) {
  double volume = 0.0;
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    const Vector2d a = outline[i], b = outline[i + 1];
    volume += M_PI / 3.0 * (a.x() * a.x() + a.x() * b.x() + b.x() * b.x()) * (b.y() - a.y());
  }
  return std::abs(volume);
}

/// Roof, skirt, round lip, upper side of the skirt, stem.
Outline FlatOutline() {
  const Vector2d bead(0.012, 0.0005), foot(0.0055, 0.0048);
  const Vector2d way = foot - bead;
  const double touch = std::atan2(way.y(), way.x()) - std::acos(0.0005 / way.norm());
  Outline outline{{0.0, 0.002}, {0.0065, 0.002}};
  AppendArc(&outline, bead, 0.0005, -M_PI / 2.0, touch);
  outline.insert(outline.end(), {foot, {0.0055, 0.009}, {0.0, 0.009}});
  return outline;
}

/// Along the middle line of the wall, half a wall to either side; its corners are rounded.
Outline BellowsOutline() {
  constexpr double kHalf = 0.00075, kFold = 0.0015, kRoof = 0.013, kStem = 0.0055;
  const Vector2d lip(0.012, kHalf), waist(0.0075, 0.0052), crest(0.012, 0.0095),
      shoulder(kStem, 0.0145);
  const auto angle_of = [](const Vector2d& v) { return std::atan2(v.y(), v.x()); };
  const double skirt = angle_of(waist - lip), cone = angle_of(crest - waist),
               upper = angle_of(shoulder - crest);
  const auto left = [](double angle) -> Vector2d { return {-std::sin(angle), std::cos(angle)}; };
  // A fillet's centre is on the bisector of the corner, kFold from both lines.
  const auto centre = [&](const Vector2d& corner, double before, double after, double side) {
    const Vector2d bisector = (left(before) + left(after)).normalized();
    return Vector2d(corner + side * kFold / bisector.dot(left(before)) * bisector);
  };
  const Vector2d waist_centre = centre(waist, skirt, cone, -1.0);  // right of the way up: outside
  const Vector2d crest_centre = centre(crest, cone, upper, 1.0);

  // On the line at half a wall to a side of the upper cone.
  const auto on_upper = [&](double side, int axis, double value) {
    const Vector2d start = crest + side * kHalf * left(upper);
    const Vector2d way(std::cos(upper), std::sin(upper));
    return Vector2d(start + way * (value - start(axis)) / way(axis));
  };
  Outline outline{{0.0, kRoof}, on_upper(1.0, 1, kRoof)};
  AppendArc(&outline, crest_centre, kFold - kHalf, upper - M_PI / 2.0, cone - M_PI / 2.0);
  AppendArc(&outline, waist_centre, kFold + kHalf, cone + M_PI / 2.0, skirt + M_PI / 2.0);
  AppendArc(&outline, lip, kHalf, skirt + M_PI / 2.0, skirt + 3.0 / 2.0 * M_PI);
  AppendArc(&outline, waist_centre, kFold - kHalf, skirt + M_PI / 2.0, cone + M_PI / 2.0);
  AppendArc(&outline, crest_centre, kFold + kHalf, cone - M_PI / 2.0, upper - M_PI / 2.0);
  outline.insert(outline.end(), {on_upper(-1.0, 0, kStem), {kStem, 0.020}, {0.0, 0.020}});
  return outline;
}

/// Distance of a point (r, z) to an outline. [m]
double DistanceTo(const Outline& outline, const Vector2d& p) {
  double nearest = 1.0;
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    const Vector2d way = outline[i + 1] - outline[i];
    if (way.squaredNorm() == 0.0) continue;
    const double t = std::min(1.0, std::max(0.0, way.dot(p - outline[i]) / way.squaredNorm()));
    nearest = std::min(nearest, (outline[i] + t * way - p).norm());
  }
  return nearest;
}

struct Cup {
  const char* mesh;
  Outline (*outline)();
  double top;     // of the stem [m]
  double roof;    // height of the cavity's apex [m]
  double lip;     // radius of the lip's lowest circle [m]
  double coarse;  // relative error of the volume allowed of facets in place of the round
};

class RevolvedCupTest : public testing::TestWithParam<Cup> {
 protected:
  const TetMesh mesh_ =
      ReadGmsh(VACUUM_GRIPPER_SOURCE_DIR "/meshes/" + std::string(GetParam().mesh) + ".msh");
  const Outline outline_ = GetParam().outline();
};

TEST_P(RevolvedCupTest, HasTheVolumeOfItsProfile) {
  const double volume = RevolvedVolume(outline_);
  EXPECT_NEAR(Volume(mesh_), volume, GetParam().coarse * volume);
}

TEST_P(RevolvedCupTest, HasTheNodesOfItsBoundaryOnItsProfile) {
  EXPECT_NEAR(mesh_.nodes.row(2).minCoeff(), 0.0, 1e-12);
  EXPECT_NEAR(mesh_.nodes.row(2).maxCoeff(), GetParam().top, 1e-12);
  const Eigen::MatrixXi& faces = mesh_.boundary_faces;
  const std::set<int> nodes(faces.data(), faces.data() + faces.size());
  for (const int node : nodes) {
    const Vector3d x = mesh_.nodes.col(node);
    // The arcs above are polygons: off by up to 1e-9 m.
    EXPECT_LT(DistanceTo(outline_, {x.head<2>().norm(), x.z()}), 1e-9) << x.transpose();
  }
}

TEST_P(RevolvedCupTest, HasItsGroupsWhereTheyBelong) {
  for (const int node : mesh_.mount_nodes) EXPECT_NEAR(mesh_.nodes(2, node), GetParam().top, 1e-12);
  const CavitySurface surface = MakeCavitySurface(mesh_);
  ASSERT_EQ(surface.port.size(), 1U);
  const Vector3d port = mesh_.nodes.col(surface.nodes[static_cast<std::size_t>(surface.port[0])]);
  EXPECT_LT((port - Vector3d(0.0, 0.0, GetParam().roof)).norm(), 1e-12);
  int lowest = 0;
  for (const int node : surface.nodes) {
    if (mesh_.nodes(2, node) > 1e-12) continue;
    EXPECT_NEAR(mesh_.nodes.col(node).head<2>().norm(), GetParam().lip, 1e-10);
    ++lowest;
  }
  EXPECT_GE(lowest, 24);
  for (const int point : surface.border) {  // on the outside of the lip
    const Vector3d x = mesh_.nodes.col(surface.nodes[static_cast<std::size_t>(point)]);
    EXPECT_GT(x.z(), 0.0);
    EXPECT_GT(x.head<2>().norm(), GetParam().lip);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cups, RevolvedCupTest,
    testing::Values(Cup{"flat_linear_700", FlatOutline, 0.009, 0.002, 0.012, 0.05},
                    Cup{"flat_quadratic_700", FlatOutline, 0.009, 0.002, 0.012, 1e-3},
                    Cup{"bellows_linear_1600", BellowsOutline, 0.020, 0.013, 0.012, 0.06},
                    Cup{"bellows_quadratic_1600", BellowsOutline, 0.020, 0.013, 0.012, 3e-3}),
    [](const auto& info) { return std::string(info.param.mesh); });

}  // namespace
}  // namespace vacuum_gripper_sim
