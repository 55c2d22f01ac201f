#include "vacuum_gripper_sim/core/triangle_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "mesh_test_tools.h"
#include "support/surface_meshes.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

TriangleMesh Make(const Triangles& mesh) { return {"thing", mesh.vertices, mesh.triangles}; }

std::vector<Vector3d> RandomPoints(int count, double width) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.5 * width, 0.5 * width);
  std::vector<Vector3d> points(static_cast<std::size_t>(count));
  for (Vector3d& p : points) {
    for (int k = 0; k < 3; ++k) p(k) = coordinate(random);
  }
  return points;
}

// How often the mesh winds around p: 1 within a solid, 0 outside.
double WindingNumber(const TriangleMesh& mesh, const Vector3d& p) {
  double winding = 0.0;
  for (int t = 0; t < mesh.num_triangles(); ++t) {
    const Vector3d a = mesh.vertices().col(mesh.triangles()(0, t)) - p;
    const Vector3d b = mesh.vertices().col(mesh.triangles()(1, t)) - p;
    const Vector3d c = mesh.vertices().col(mesh.triangles()(2, t)) - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    winding +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return winding / (2.0 * M_PI);
}

double BruteForceDistance(const TriangleMesh& mesh, const Vector3d& p) {
  double squared = std::numeric_limits<double>::infinity();
  for (int t = 0; t < mesh.num_triangles(); ++t) {
    squared = std::min(squared, NearestOnTriangle(mesh.vertices().col(mesh.triangles()(0, t)),
                                                  mesh.vertices().col(mesh.triangles()(1, t)),
                                                  mesh.vertices().col(mesh.triangles()(2, t)), p)
                                    .squared_distance);
  }
  return std::sqrt(squared);
}

TEST(TriangleMesh, ABoxOfTrianglesIsABox) {
  const Vector3d size(0.3, 0.2, 0.1);
  for (const int n : {1, 5}) {
    const TriangleMesh mesh = Make(MakeBoxMesh(n, size));
    EXPECT_TRUE(mesh.closed());
    EXPECT_EQ(mesh.num_shells(), 1);
    for (const Vector3d& p : RandomPoints(2000, 0.5)) {
      const Vector3d excess = p.cwiseAbs() - 0.5 * size;
      const double expected = excess.cwiseMax(0.0).norm() + std::min(0.0, excess.maxCoeff());
      const MeshPoint seen = *mesh.Nearest(p);
      EXPECT_NEAR(seen.distance, expected, 1e-15);
      EXPECT_NEAR(seen.normal.norm(), 1.0, 1e-12);
      Vector3d nearest = Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        nearest += seen.weights(k) * mesh.vertices().col(mesh.triangles()(k, seen.triangle));
      }
      EXPECT_LT((nearest + seen.distance * seen.normal - p).norm(), 1e-14);
    }
  }
}

// Facets lie within the sphere by their sagitta: edge^2 / (8 r) along an edge, a third more within.
TEST(TriangleMesh, ASphereOfTrianglesIsASphereUpToItsFacets) {
  const double radius = 0.1;
  for (const int n : {8, 16, 32}) {
    const TriangleMesh mesh = Make(MakeSphereMesh(n, radius));
    const double edge = std::sqrt(2.0) * 0.5 * M_PI * radius / n;
    for (const Vector3d& p : RandomPoints(500, 0.3)) {
      const double error = mesh.Nearest(p)->distance - (p.norm() - radius);
      EXPECT_GE(error, -1e-14);
      EXPECT_LE(error, edge * edge / (6.0 * radius));
    }
  }
}

TEST(TriangleMesh, TheTreeFindsWhatALookAtEveryTriangleFinds) {
  Triangles bumpy = MakeSphereMesh(12, 0.05);
  for (Eigen::Index v = 0; v < bumpy.vertices.cols(); ++v) {
    Vector3d p = bumpy.vertices.col(v);
    bumpy.vertices.col(v) *= 1.0 + 0.3 * std::sin(90.0 * p.x()) * std::cos(70.0 * p.y());
  }
  const TriangleMesh mesh = Make(bumpy);
  ASSERT_TRUE(mesh.closed());
  int inside = 0;
  for (const Vector3d& p : RandomPoints(1000, 0.15)) {
    const double distance = BruteForceDistance(mesh, p);
    const MeshPoint seen = *mesh.Nearest(p);
    EXPECT_NEAR(std::abs(seen.distance), distance, 1e-15);
    EXPECT_EQ(seen.distance<0.0, WindingNumber(mesh, p)> 0.5);
    inside += seen.distance < 0.0 ? 1 : 0;
    EXPECT_FALSE(mesh.Nearest(p, 0.999 * distance));
    // A hint shortens the search and changes nothing.
    for (const int hint : {0, mesh.num_triangles() / 2, seen.triangle}) {
      const MeshPoint again = *mesh.Nearest(p, 1.0, hint);
      EXPECT_EQ(again.triangle, seen.triangle);
      EXPECT_EQ(again.distance, seen.distance);
      EXPECT_EQ(again.normal, seen.normal);
    }
  }
  EXPECT_GT(inside, 50);
}

// At a vertex of a sharp roof single faces say "inside" of points that are not: the pseudonormal's
// case. [Baerentzen & Aanaes 2005, Fig. 1]
TEST(TriangleMesh, SignsAtSharpEdgesAndCorners) {
  Triangles spike;  // a tetrahedron with a needle's point
  spike.vertices.resize(3, 4);
  spike.vertices << 0.0, 0.01, 0.0, 0.003,  //
      0.0, 0.0, 0.01, 0.003,                //
      0.0, 0.0, 0.0, 0.3;
  spike.triangles.resize(3, 4);
  spike.triangles << 0, 0, 1, 2,  //
      2, 1, 2, 0,                 //
      1, 3, 3, 3;
  const TriangleMesh mesh = Make(spike);
  ASSERT_TRUE(mesh.closed());
  int inside = 0;
  for (const Vector3d& direction : RandomPoints(4000, 1.0)) {
    for (int v = 0; v < 4; ++v) {
      const Vector3d p = mesh.vertices().col(v) + 0.02 * direction;
      const bool within = WindingNumber(mesh, p) > 0.5;
      EXPECT_EQ(mesh.Nearest(p)->distance < 0.0, within) << p.transpose();
      inside += within ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 10);
}

TEST(TriangleMesh, OnTheSurfaceTheNormalIsThePseudonormal) {
  const TriangleMesh mesh = Make(MakeBoxMesh(2, {0.2, 0.2, 0.2}));
  EXPECT_EQ(mesh.Nearest({0.1, 0.03, 0.01})->normal, Vector3d::UnitX());
  EXPECT_LT((mesh.Nearest({0.1, 0.1, 0.04})->normal - Vector3d(1, 1, 0).normalized()).norm(),
            1e-12);
  EXPECT_LT((mesh.Nearest({0.1, 0.1, 0.1})->normal - Vector3d(1, 1, 1).normalized()).norm(), 1e-12);
}

TEST(TriangleMesh, JoinsTheCornersOfASoup) {
  const Triangles box = MakeBoxMesh(3, {0.3, 0.2, 0.1});
  Triangles soup = Soup(box);
  soup.vertices.row(0).array() += 1e-9 * soup.vertices.row(1).array().sin();  // and a little noise
  const TriangleMesh mesh = Make(soup);
  EXPECT_EQ(mesh.vertices().cols(), 6 * 9 + 2);
  EXPECT_EQ(mesh.merged_vertices(), soup.vertices.cols() - 56);
  EXPECT_TRUE(mesh.closed());
}

TEST(TriangleMesh, DropsTrianglesWithoutCornersAndTwins) {
  Triangles box = MakeBoxMesh(2, {0.2, 0.2, 0.2});
  const Eigen::Index count = box.triangles.cols();
  box.triangles.conservativeResize(3, count + 3);
  box.triangles.col(count) << 0, 0, 1;
  box.triangles.col(count + 1) = box.triangles.col(4);
  box.triangles.col(count + 2) = box.triangles.col(5).reverse();
  const TriangleMesh mesh = Make(box);
  EXPECT_EQ(mesh.num_triangles(), count);
  EXPECT_EQ(mesh.dropped_triangles(), 3);
  EXPECT_TRUE(mesh.closed());
  EXPECT_NEAR(mesh.Nearest({0.0, 0.0, 0.0})->distance, -0.1, 1e-15);
}

// A triangle without area between two others holds them together and has no say in the sign.
TEST(TriangleMesh, FlatTrianglesOnlyJoin) {
  Triangles tent;  // a tetrahedron with a vertex on the edge from 0 to 1, on one side of it alone
  tent.vertices.resize(3, 5);
  tent.vertices << 0.0, 1.0, 0.0, 0.0, 0.5,  //
      0.0, 0.0, 1.0, 0.0, 0.0,               //
      0.0, 0.0, 0.0, 1.0, 0.0;
  tent.triangles.resize(3, 6);
  tent.triangles << 0, 4, 0, 0, 1, 0,  //
      2, 2, 1, 3, 2, 4,                //
      4, 1, 3, 2, 3, 1;
  const TriangleMesh mesh = Make(tent);
  EXPECT_TRUE(mesh.closed());
  EXPECT_EQ(mesh.normal(5), Vector3d::Zero());
  for (const Vector3d& p : RandomPoints(1000, 2.5)) {
    EXPECT_EQ(mesh.Nearest(p)->distance<0.0, WindingNumber(mesh, p)> 0.5) << p.transpose();
  }
}

TEST(TriangleMesh, TurnsWhatIsWoundAgainstItsNeighbours) {
  Triangles sphere = MakeSphereMesh(6, 0.1);
  int turned = 0;
  for (Eigen::Index t = 0; t < sphere.triangles.cols(); t += 5, ++turned) {
    sphere.triangles.col(t).reverseInPlace();
  }
  const TriangleMesh mesh = Make(sphere);
  EXPECT_EQ(mesh.turned_triangles(), turned);
  EXPECT_TRUE(mesh.closed());
  EXPECT_GT(mesh.Nearest({0.2, 0.0, 0.0})->distance, 0.09);
  EXPECT_LT(mesh.Nearest({0.0, 0.0, 0.0})->distance, -0.09);

  for (Eigen::Index t = 0; t < sphere.triangles.cols(); ++t) {
    sphere.triangles.col(t).reverseInPlace();
  }
  EXPECT_LT(Make(sphere).Nearest({0.0, 0.0, 0.0})->distance, -0.09);  // inside out
}

TEST(TriangleMesh, ShellsApartAndWithin) {
  Triangles hollow = MakeSphereMesh(6, 0.03);
  for (Eigen::Index t = 0; t < hollow.triangles.cols(); ++t) {
    hollow.triangles.col(t).reverseInPlace();
  }
  Triangles apart = hollow;  // inside out, too, but in nothing
  apart.vertices.row(0).array() += 0.5;
  const TriangleMesh mesh = Make(Join(Join(MakeSphereMesh(6, 0.1), hollow), apart));
  EXPECT_EQ(mesh.num_shells(), 3);
  EXPECT_TRUE(mesh.closed());
  EXPECT_GT(mesh.Nearest({0.0, 0.0, 0.0})->distance, 0.02);    // the void
  EXPECT_LT(mesh.Nearest({0.05, 0.0, 0.0})->distance, -0.01);  // the wall
  EXPECT_LT(mesh.Nearest({0.5, 0.0, 0.0})->distance, -0.02);
}

// Two cubes that have an edge in common: four triangles meet there.
TEST(TriangleMesh, SolidsThatTouchAlongAnEdge) {
  Triangles a = MakeBoxMesh(1, {0.1, 0.1, 0.1});
  Triangles b = a;
  b.vertices.row(0).array() += 0.1;
  b.vertices.row(1).array() += 0.1;
  const TriangleMesh mesh = Make(Join(a, b));
  EXPECT_TRUE(mesh.closed());
  EXPECT_EQ(mesh.num_shells(), 1);
  for (const Vector3d& p : RandomPoints(1000, 0.4)) {
    EXPECT_EQ(mesh.Nearest(p)->distance<0.0, WindingNumber(mesh, p)> 0.5) << p.transpose();
  }
}

TEST(TriangleMesh, AHoleMakesASheet) {
  Triangles sphere = MakeSphereMesh(6, 0.1);
  sphere.triangles = sphere.triangles.rightCols(sphere.triangles.cols() - 1).eval();
  const TriangleMesh mesh = Make(sphere);
  EXPECT_FALSE(mesh.closed());
  EXPECT_FALSE(mesh.shell_closed(0));
  // From outside it is the sphere, from inside its hollow.
  EXPECT_GT(mesh.SeenFrom(1, *mesh.Nearest({0.12, 0.0, 0.0})).distance, 0.015);
  EXPECT_LT(mesh.SeenFrom(1, *mesh.Nearest({0.09, 0.01, 0.0})).distance, -0.005);
  EXPECT_GT(mesh.SeenFrom(-1, *mesh.Nearest({0.09, 0.01, 0.0})).distance, 0.005);
}

TEST(TriangleMesh, PastTheBorderOfASheet) {
  const TriangleMesh mesh = Make(MakeSheet(4, 0.2));
  for (const int side : {1, -1}) {
    const auto seen = [&](const Vector3d& p) { return mesh.SeenFrom(side, *mesh.Nearest(p)); };
    EXPECT_NEAR(seen({0.03, 0.02, 0.004}).distance, side * 0.004, 1e-15);
    EXPECT_NEAR(seen({0.03, 0.02, -0.004}).distance, side * -0.004, 1e-15);
    EXPECT_LT((seen({0.03, 0.02, 0.004}).normal - side * Vector3d::UnitZ()).norm(), 1e-12);
    for (const double height : {0.04, -0.04}) {  // past it: away from the border, on both sides
      EXPECT_NEAR(seen({0.13, 0.02, height}).distance, 0.05, 1e-15);
      EXPECT_LT((seen({0.13, 0.02, height}).normal - Vector3d(0.6, 0.0, height / 0.05)).norm(),
                1e-12);
    }
    // What solvers leave of a node that slides over the border: level with the sheet.
    const MeshPoint level = seen({0.1 + 1e-5, 0.02, -side * 1e-6});
    EXPECT_NEAR(level.distance, 1e-5, 1e-15);
    EXPECT_LT((level.normal - Vector3d::UnitX()).norm(), 1e-9);
  }
}

TEST(TriangleMesh, RefusesWhatIsNoSurface) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Triangles sheet = MakeSheet(1, 1.0);
  ExpectInvalid([&] { TriangleMesh("bowl.stl", sheet.vertices, Eigen::Matrix3Xi(3, 0)); },
                {"bowl.stl", "no triangles"});
  Triangles bad = sheet;
  bad.vertices(1, 2) = nan;
  ExpectInvalid([&] { Make(bad); }, {"thing", "vertex 2", "finite"});
  bad = sheet;
  bad.triangles(0, 1) = 9;
  ExpectInvalid([&] { Make(bad); }, {"thing", "triangle 1", "vertex 9", "0 .. 3"});
  bad = sheet;
  bad.vertices.row(0).setZero();
  ExpectInvalid([&] { Make(bad); }, {"thing", "none of the mesh's 2 triangles has an area"});
}

}  // namespace
}  // namespace vacuum_gripper_sim
