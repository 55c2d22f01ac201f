#include "vacuum_gripper_sim/core/surface_sighting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "support/surface_meshes.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

Mesh Share(const Triangles& mesh) {
  return std::make_shared<TriangleMesh>("thing", mesh.vertices, mesh.triangles);
}

void ExpectSame(const SurfaceDistance& a, const SurfaceDistance& b) {
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.normal, b.normal);
}

TEST(SurfaceSighting, OfSolidsIsTheirDistanceWhateverWasSeenBefore) {
  for (const Shape& shape : {Shape(Plane{}), Shape(Box{{0.1, 0.2, 0.1}}), Shape(Sphere{0.1}),
                             Shape(Cylinder{0.1, 0.1}), Shape(Share(MakeSphereMesh(8, 0.1)))}) {
    SurfaceSighting sighting;
    for (int i = 0; i < 300; ++i) {
      const Vector3d p(0.15 * std::sin(0.1 * i), 0.15 * std::cos(0.13 * i),
                       0.1 * std::sin(1.7 * i));
      ExpectSame(i % 3 == 0 ? sighting.BeginStep(shape, p) : sighting.Look(shape, p),
                 Distance(shape, p));
      ExpectSame(sighting.Look(shape, p), Distance(shape, p));
    }
  }
}

TEST(SurfaceSighting, WithinReachExactBeyondALowerBound) {
  const Shape shape(Share(MakeSphereMesh(8, 0.1)));
  const double reach = 0.02;
  SurfaceSighting sighting;
  int bounded = 0;
  for (int i = 0; i < 400; ++i) {
    const Vector3d p(0.0, 0.05 * std::sin(0.05 * i), 0.15 + 0.06 * std::cos(0.02 * i));
    const double seen = sighting.Look(shape, p, reach).distance;
    const double exact = Distance(shape, p).distance;
    if (seen != exact) {
      ++bounded;
      EXPECT_GE(seen, reach);
      EXPECT_LE(seen, exact);
    }
    EXPECT_TRUE(exact >= reach || seen == exact);
  }
  EXPECT_GT(bounded, 50);
  EXPECT_LT(bounded, 390);
}

TEST(SurfaceSighting, ASheetHasTheSideWhereThePointWasFirstSeen) {
  const Shape sheet(Share(MakeSheet(4, 0.2)));
  for (const double side : {1.0, -1.0}) {
    SurfaceSighting sighting;
    EXPECT_NEAR(sighting.BeginStep(sheet, {0.01, 0.0, side * 0.002}).distance, 0.002, 1e-15);
    // Trials do not change it, however far they go.
    EXPECT_NEAR(sighting.Look(sheet, {0.01, 0.0, -side * 0.03}).distance, -0.03, 1e-15);
    for (const double depth : {1e-9, 1e-4, 4e-3, 1e-6}) {
      const SurfaceDistance seen = sighting.BeginStep(sheet, {0.01, 0.013, -side * depth});
      EXPECT_NEAR(seen.distance, -depth, 1e-15);
      EXPECT_LT((seen.normal - side * Vector3d::UnitZ()).norm(), 1e-12);
    }
    // Too deep to have been pressed there.
    EXPECT_NEAR(sighting.BeginStep(sheet, {0.01, 0.0, -side * 0.03}).distance, 0.03, 1e-15);
    EXPECT_NEAR(sighting.BeginStep(sheet, {0.01, 0.0, -side * 0.001}).distance, 0.001, 1e-15);
  }
}

TEST(SurfaceSighting, RoundTheBorderToTheOtherSide) {
  const Shape sheet(Share(MakeSheet(4, 0.2)));
  SurfaceSighting sighting;
  const double radius = 0.002;  // around the border at x = .1
  sighting.BeginStep(sheet, {0.09, 0.0, radius});
  for (int i = 0; i <= 40; ++i) {
    const double angle = M_PI_2 - M_PI * i / 40;
    const Vector3d p(0.1 + radius * std::cos(angle), 0.0, radius * std::sin(angle));
    EXPECT_NEAR(sighting.BeginStep(sheet, p).distance, radius, 1e-15);
  }
  EXPECT_NEAR(sighting.BeginStep(sheet, {0.09, 0.0, -radius}).distance, radius, 1e-15);
}

// A node that solvers leave a little below the sheet slides over its border and back.
TEST(SurfaceSighting, OverTheBorderAndBackOnTheSameSide) {
  const Shape sheet(Share(MakeSheet(4, 0.2)));
  SurfaceSighting sighting;
  sighting.BeginStep(sheet, {0.09, 0.0, 1e-3});
  for (const double x : {0.095, 0.0999, 0.1001, 0.103, 0.1001, 0.0999, 0.095}) {
    const double expected = x > 0.1 ? x - 0.1 : -1e-6;
    EXPECT_NEAR(sighting.BeginStep(sheet, {x, 0.0, -1e-6}).distance, expected, 1e-12) << x;
  }
}

TEST(SurfaceSighting, FarAwayItForgetsItsSide) {
  const Shape sheet(Share(MakeSheet(4, 0.2)));
  const double reach = 0.01;
  SurfaceSighting sighting;
  sighting.BeginStep(sheet, {0.0, 0.0, 0.002}, reach);
  for (int i = 0; i <= 40; ++i) {  // round the sheet, out of reach
    const double angle = M_PI_2 - M_PI * i / 40;
    sighting.BeginStep(sheet, {0.3 * std::cos(angle), 0.0, 0.3 * std::sin(angle)}, reach);
  }
  EXPECT_NEAR(sighting.BeginStep(sheet, {0.0, 0.0, -0.003}, reach).distance, 0.003, 1e-15);
}

// Two sheets one above the other in one mesh: a node between them has a side of each.
TEST(SurfaceSighting, OneSideForEachSheet) {
  Triangles lower = MakeSheet(2, 0.2);
  Triangles upper = lower;
  upper.vertices.row(2).setConstant(0.02);
  const Shape both(Share(Join(lower, upper)));
  SurfaceSighting sighting;
  EXPECT_NEAR(sighting.BeginStep(both, {0.01, 0.0, 0.002}).distance, 0.002, 1e-15);
  EXPECT_NEAR(sighting.BeginStep(both, {0.01, 0.0, 0.018}).distance, 0.002, 1e-15);
  EXPECT_NEAR(sighting.BeginStep(both, {0.01, 0.0, 0.0201}).distance, -0.0001, 1e-15);
  EXPECT_NEAR(sighting.BeginStep(both, {0.01, 0.0, 0.001}).distance, 0.001, 1e-15);
  EXPECT_NEAR(sighting.BeginStep(both, {0.01, 0.0, -0.001}).distance, -0.001, 1e-15);
}

}  // namespace
}  // namespace vacuum_gripper_sim
