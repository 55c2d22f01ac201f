#include "vacuum_gripper_sim/core/cup_faces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/block_mesh.h"
#include "vacuum_gripper_sim/core/gmsh_reader.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

TetMesh Bell(const std::string& name) {
  return ReadGmsh(std::string(VACUUM_GRIPPER_SOURCE_DIR) + "/meshes/bell_" + name + ".msh");
}

Vector3d RandomPoint(std::mt19937* random, const Vector3d& lower, const Vector3d& upper) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Vector3d share(unit(*random), unit(*random), unit(*random));
  return lower + share.cwiseProduct(upper - lower);
}

// Signed distance to the box [0, size], out of its faces.
double BoxDistance(const Vector3d& size, const Vector3d& p) {
  const Vector3d excess = (p - 0.5 * size).cwiseAbs() - 0.5 * size;
  return excess.cwiseMax(0.0).norm() + std::min(0.0, excess.maxCoeff());
}

TEST(CupFaces, ABlocksDistanceIsThatOfABox) {
  const Vector3d size(0.03, 0.02, 0.01);
  for (const bool quadratic : {false, true}) {
    const CupFaces faces(WithBoundary(MakeBlock(4, 3, 2, size, quadratic)));
    EXPECT_EQ(faces.num_faces(), (quadratic ? 4 : 1) * 2 * 2 * (4 * 3 + 4 * 2 + 3 * 2));
    std::mt19937 random(3);
    for (int i = 0; i < 500; ++i) {
      const Vector3d p = RandomPoint(&random, -size, 2.0 * size);
      const auto seen = faces.Nearest(p, 1.0);
      ASSERT_TRUE(seen);
      EXPECT_NEAR(seen->distance, BoxDistance(size, p), 1e-15);
      // What it says of itself agrees: weights, position, distance and normal.
      EXPECT_NEAR(seen->weights.sum(), 1.0, 1e-14);
      EXPECT_GE(seen->weights.minCoeff(), -1e-14);
      EXPECT_LT((seen->position_W + seen->distance * seen->normal_W - p).norm(), 1e-14);
      EXPECT_EQ(seen->nodes[1], faces.triangles()(1, seen->face));
    }
  }
}

TEST(CupFaces, TouchingPointsHaveAnOutwardNormal) {
  const CupFaces faces(WithBoundary(MakeBlock(1, 1, 1, {0.01, 0.01, 0.01}, false)));
  const auto face = faces.Nearest({0.01, 0.004, 0.003}, 1e-3);
  ASSERT_TRUE(face);
  EXPECT_LT((face->normal_W - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_NEAR(face->distance, 0.0, 1e-15);
  const auto corner = faces.Nearest({0.01, 0.01, 0.01}, 1e-3);
  ASSERT_TRUE(corner);
  EXPECT_LT((corner->normal_W - Vector3d::Ones().normalized()).norm(), 1e-12);
}

TEST(CupFaces, TheTreeFindsWhatALookAtEveryFaceFindsAlsoDeformed) {
  for (const char* const bell : {"linear_700", "quadratic_700"}) {
    const TetMesh mesh = Bell(bell);
    CupFaces faces(mesh);
    Eigen::Matrix3Xd x = 1.2 * mesh.nodes;  // and bent
    for (Eigen::Index n = 0; n < x.cols(); ++n) x(0, n) += 20.0 * x(2, n) * x(2, n);
    faces.Update(x);
    std::mt19937 random(1);
    const Vector3d lower = faces.bounds_W().min(), upper = faces.bounds_W().max();
    for (int i = 0; i < 200; ++i) {
      const Vector3d p = RandomPoint(&random, lower - 0.3 * (upper - lower), upper);
      double nearest = 1e300;
      for (int f = 0; f < faces.num_faces(); ++f) {
        const auto& corners = faces.triangles().col(f);
        nearest = std::min(
            nearest, NearestOnTriangle(x.col(corners(0)), x.col(corners(1)), x.col(corners(2)), p)
                         .squared_distance);
      }
      const auto seen = faces.Nearest(p, 1.0);
      ASSERT_TRUE(seen);
      EXPECT_NEAR(std::abs(seen->distance), std::sqrt(nearest), 1e-15);
      EXPECT_FALSE(faces.Nearest(p, 0.999 * std::sqrt(nearest)));
      EXPECT_TRUE(faces.Nearest(p, 1.001 * std::sqrt(nearest)));
    }
  }
}

// Sign: the solid angle of the whole boundary is 4 pi inside the material and 0 outside.
TEST(CupFaces, PositiveOutsideTheMaterialAlsoInTheCavity) {
  const TetMesh mesh = Bell("quadratic_700");
  const CupFaces faces(mesh);
  std::mt19937 random(2);
  int inside = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3d p = RandomPoint(&random, faces.bounds_W().min(), faces.bounds_W().max());
    double winding = 0.0;
    for (int f = 0; f < faces.num_faces(); ++f) {
      const Vector3d a = mesh.nodes.col(faces.triangles()(0, f)) - p;
      const Vector3d b = mesh.nodes.col(faces.triangles()(1, f)) - p;
      const Vector3d c = mesh.nodes.col(faces.triangles()(2, f)) - p;
      const double la = a.norm(), lb = b.norm(), lc = c.norm();
      winding += std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb) /
                 (2.0 * M_PI);
    }
    const auto seen = faces.Nearest(p, 1.0);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->distance<0.0, winding> 0.5) << p.transpose() << ' ' << seen->distance;
    inside += winding > 0.5 ? 1 : 0;
  }
  EXPECT_GT(inside, 30);
  EXPECT_LT(inside, 470);
}

TEST(CupFaces, SkipsFacesThatAreNotWanted) {
  const TetMesh mesh = Bell("linear_700");
  const CupFaces faces(mesh);
  const int node = mesh.boundary_faces(0, 7);
  const Vector3d p = mesh.nodes.col(node);
  ASSERT_TRUE(faces.Nearest(p, 1e-9));
  const auto others = [&](int face) { return (faces.triangles().col(face).array() != node).all(); };
  const auto seen = faces.Nearest(p, 1.0, others);
  ASSERT_TRUE(seen);
  EXPECT_TRUE(others(seen->face));
  EXPECT_GT(std::abs(seen->distance), 1e-6);
  EXPECT_FALSE(faces.Nearest(p, 0.99 * std::abs(seen->distance), others));
}

}  // namespace
}  // namespace vacuum_gripper_sim
