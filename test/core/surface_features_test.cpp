#include "vacuum_gripper_sim/core/surface_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "support/surface_meshes.h"
#include "vacuum_gripper_sim/core/triangle_mesh.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

const Vector3d kSize(0.10, 0.06, 0.02);

Mesh Share(const Triangles& mesh) {
  return std::make_shared<TriangleMesh>("thing", mesh.vertices, mesh.triangles);
}

double NearestTo(const Vector3d& p, const std::vector<FeaturePoint>& points) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const FeaturePoint& point : points) nearest = std::min(nearest, (point.p_S - p).norm());
  return nearest;
}

/// How many of the box's faces a point lies on.
int FacesAt(const Vector3d& p) {
  return static_cast<int>(((p.cwiseAbs() - 0.5 * kSize).cwiseAbs().array() < 1e-12).count());
}

void ExpectCoversEdgesOfTheBox(const std::vector<FeaturePoint>& points, double spacing) {
  int corners = 0;
  for (const FeaturePoint& point : points) {
    EXPECT_GE(FacesAt(point.p_S), 2) << point.p_S.transpose();
    corners += FacesAt(point.p_S) == 3 ? 1 : 0;
    EXPECT_NEAR(point.outward_S.norm(), 1.0, 1e-12);
    // Out of the solid, between its faces.
    const Vector3d ahead = point.p_S + 1e-4 * point.outward_S;
    EXPECT_GT(Distance(Box{kSize}, ahead).distance, 0.9e-4);
  }
  EXPECT_EQ(corners, 8);
  for (int axis = 0; axis < 3; ++axis) {
    for (int edge = 0; edge < 4; ++edge) {
      for (int i = 0; i <= 200; ++i) {
        Vector3d p;
        p(axis) = kSize(axis) * (i / 200.0 - 0.5);
        p((axis + 1) % 3) = (edge % 2 - 0.5) * kSize((axis + 1) % 3);
        p((axis + 2) % 3) = (edge / 2 - 0.5) * kSize((axis + 2) % 3);
        EXPECT_LE(NearestTo(p, points), 0.5 * spacing + 1e-12);
      }
    }
  }
}

TEST(SharpFeatures, EdgesAndCornersOfABox) {
  for (const double spacing : {0.001, 0.0033, 0.05}) {
    SCOPED_TRACE(spacing);
    const auto points = SharpFeatures(Box{kSize}, spacing);
    ExpectCoversEdgesOfTheBox(points, spacing);
    std::size_t expected = 8;
    for (int axis = 0; axis < 3; ++axis) {
      expected += 4 * static_cast<std::size_t>(std::ceil(kSize(axis) / spacing - 1e-9) - 1);
    }
    EXPECT_EQ(points.size(), expected);
  }
}

// The same of triangles: coplanar faces have no edge between them, fine ones no crowd of points.
TEST(SharpFeatures, EdgesOfABoxOfTriangles) {
  for (const int n : {1, 4}) {
    const auto points = SharpFeatures(Share(MakeBoxMesh(n, kSize)), 0.003);
    ExpectCoversEdgesOfTheBox(points, 0.003);
  }
  const double spacing = 0.01;  // of edges of 0.1 and 0.06 / 64 m
  const auto thinned = SharpFeatures(Share(MakeBoxMesh(64, kSize)), spacing);
  EXPECT_LT(thinned.size(), 8 + 4 * (0.18 / (0.5 * spacing)));
  for (int i = 0; i <= 100; ++i) {
    EXPECT_LE(NearestTo({0.1 * (i / 100.0 - 0.5), 0.03, 0.01}, thinned), 0.5 * spacing);
  }
  EXPECT_EQ(std::count_if(thinned.begin(), thinned.end(),
                          [](const FeaturePoint& point) { return FacesAt(point.p_S) == 3; }),
            8);
}

TEST(SharpFeatures, BothEdgesOfAThinPlate) {
  const auto points = SharpFeatures(Share(MakeBoxMesh(8, {0.1, 0.1, 0.001})), 0.005);
  for (const double height : {0.0005, -0.0005}) {
    for (int i = 0; i <= 100; ++i) {
      const Vector3d p(0.1 * (i / 100.0 - 0.5), 0.05, height);
      const bool covered = std::any_of(points.begin(), points.end(), [&](const FeaturePoint& q) {
        return (q.p_S - p).norm() <= 0.0025 + 1e-12 && q.p_S.z() == height;
      });
      EXPECT_TRUE(covered) << p.transpose();
    }
  }
}

TEST(SharpFeatures, RimsOfACylinder) {
  const Cylinder cylinder{0.03, 0.1};
  const double spacing = 0.002;
  const auto points = SharpFeatures(cylinder, spacing);
  EXPECT_EQ(points.size(), 2 * static_cast<std::size_t>(std::ceil(2.0 * M_PI * 0.03 / spacing)));
  for (const FeaturePoint& point : points) {
    EXPECT_NEAR(point.p_S.head<2>().norm(), 0.03, 1e-15);
    EXPECT_NEAR(std::abs(point.p_S.z()), 0.05, 1e-15);
    EXPECT_NEAR(Distance(cylinder, point.p_S + 1e-3 * point.outward_S).distance, 1e-3, 1e-15);
  }
  for (int i = 0; i < 360; ++i) {
    const double angle = i * M_PI / 180.0;
    const Vector3d rim(0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.05);
    EXPECT_LE(NearestTo(rim, points), 0.5 * spacing);
  }
}

TEST(SharpFeatures, RoundAndFlatThingsHaveNone) {
  EXPECT_TRUE(SharpFeatures(Plane{}, 0.001).empty());
  EXPECT_TRUE(SharpFeatures(Sphere{0.1}, 0.001).empty());
  EXPECT_TRUE(SharpFeatures(Share(MakeSphereMesh(8, 0.1)), 0.001).empty());
}

TEST(SharpFeatures, BordersOfASheet) {
  const auto points = SharpFeatures(Share(MakeSheet(3, 0.2)), 0.01);
  EXPECT_EQ(points.size(), 4U * 21U);  // each third of a side is 7 pieces
  for (const FeaturePoint& point : points) {
    EXPECT_NEAR(point.p_S.cwiseAbs().maxCoeff(), 0.1, 1e-15);
    EXPECT_GT(point.outward_S.dot(point.p_S), 0.0999);
    EXPECT_EQ(point.outward_S.z(), 0.0);
  }
}

// A groove's bottom cannot poke into anything; its two upper edges can.
TEST(SharpFeatures, OnlyConvexEdgesOfASolid) {
  // A prism along y, its section an M: a block with a V cut into its top.
  const double section[5][2] = {{0.0, 0.0}, {0.1, 0.0}, {0.1, 0.1}, {0.05, 0.04}, {0.0, 0.1}};
  Triangles prism;
  prism.vertices.resize(3, 10);
  for (int i = 0; i < 5; ++i) {
    prism.vertices.col(i) << section[i][0], 0.0, section[i][1];
    prism.vertices.col(5 + i) << section[i][0], 0.2, section[i][1];
  }
  prism.triangles.resize(3, 16);
  int t = 0;
  for (int i = 0; i < 5; ++i) {
    const int next = (i + 1) % 5;
    prism.triangles.col(t++) << i, next + 5, next;
    prism.triangles.col(t++) << i, i + 5, next + 5;
  }
  for (const auto& cap : {Eigen::Vector3i(0, 1, 3), {1, 2, 3}, {0, 3, 4}}) {
    prism.triangles.col(t++) = cap;
    prism.triangles.col(t++) = (cap.array() + 5).reverse().matrix();
  }
  const Mesh mesh = Share(prism);
  ASSERT_TRUE(mesh->closed());
  const auto points = SharpFeatures(mesh, 0.01);
  EXPECT_GT(NearestTo({0.05, 0.1, 0.04}, points), 0.05);
  for (const int edge : {0, 1, 2, 4}) {
    EXPECT_LE(NearestTo({section[edge][0], 0.1, section[edge][1]}, points), 0.005 + 1e-12);
  }
}

TEST(SharpFeatures, RefusesASpacingThatIsNone) {
  EXPECT_THROW(SharpFeatures(Box{kSize}, 0.0), std::invalid_argument);
  EXPECT_THROW(SharpFeatures(Box{kSize}, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace vacuum_gripper_sim
