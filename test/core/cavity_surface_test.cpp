#include "vacuum_gripper_sim/core/cavity_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "mesh_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Only nodes and cavity faces matter to the cavity surface.
TetMesh SurfaceMesh(const Matrix3Xd& nodes, const Eigen::MatrixXi& faces) {
  TetMesh mesh;
  mesh.source = "drawn.msh";
  mesh.nodes = nodes;
  mesh.cavity_faces = faces;
  return mesh;
}

// A dome over a regular n-gon of circumradius R in the plane z = 0; node n is the apex. The faces
// point down, out of the material and into the cavity's air.
constexpr int kSides = 24;
constexpr double kRadius = 0.015;  // [m]

TetMesh Dome(const Vector3d& apex) {
  Matrix3Xd nodes(3, kSides + 1);
  Eigen::MatrixXi faces(3, kSides);
  for (int i = 0; i < kSides; ++i) {
    const double t = 2.0 * M_PI * i / kSides;
    nodes.col(i) << kRadius * std::cos(t), kRadius * std::sin(t), 0.0;
    faces.col(i) << kSides, (i + 1) % kSides, i;
  }
  nodes.col(kSides) = apex;
  return SurfaceMesh(nodes, faces);
}

// The same with 6-node faces: n + 1 + i is the middle of the spoke i, 2 n + 1 + i that of the rim's
// edge i; all of them off the straight edges.
TetMesh QuadraticDome(const Vector3d& apex) {
  TetMesh mesh = Dome(apex);
  mesh.nodes.conservativeResize(3, 3 * kSides + 1);
  mesh.cavity_faces.resize(6, kSides);
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    mesh.nodes.col(kSides + 1 + i) =
        0.5 * (mesh.nodes.col(i) + apex) + Vector3d(1e-4 * i, 2e-4, 1e-3);
    const double t = 2.0 * M_PI * (i + 0.5) / kSides;
    mesh.nodes.col(2 * kSides + 1 + i) << kRadius * std::cos(t), kRadius * std::sin(t), 0.0;
    mesh.cavity_faces.col(i) << kSides, next, i, kSides + 1 + next, 2 * kSides + 1 + i,
        kSides + 1 + i;
  }
  return mesh;
}

double PolygonArea(const int sides) {
  return 0.5 * sides * kRadius * kRadius * std::sin(2.0 * M_PI / sides);
}

TEST(MakeCavitySurface, ReadsTheGraphOfADome) {
  const CavitySurface surface = MakeCavitySurface(Dome({0.001, 0.0, 0.009}));
  EXPECT_EQ(surface.num_points(), kSides + 1);
  EXPECT_EQ(surface.triangles.cols(), kSides);
  ASSERT_EQ(surface.border.size(), static_cast<std::size_t>(kSides));
  EXPECT_EQ(surface.border.front(), 0);
  EXPECT_EQ(surface.border.back(), kSides - 1);
  EXPECT_EQ(surface.port, std::vector<int>{kSides});
  EXPECT_EQ(surface.neighbours[0], (std::vector<int>{1, kSides - 1, kSides}));
  EXPECT_EQ(surface.neighbours[kSides].size(), static_cast<std::size_t>(kSides));
}

TEST(MakeCavitySurface, MidEdgeNodesArePointsToo) {
  const CavitySurface surface = MakeCavitySurface(QuadraticDome({0.0, 0.0, 0.009}));
  EXPECT_EQ(surface.num_points(), 3 * kSides + 1);
  EXPECT_EQ(surface.triangles.cols(), 4 * kSides);
  EXPECT_EQ(surface.border.size(), static_cast<std::size_t>(2 * kSides));
  EXPECT_EQ(surface.port, std::vector<int>{kSides});
  // A corner of the rim: the middles of its two rim edges and of its spoke, no corner.
  EXPECT_EQ(surface.neighbours[1], (std::vector<int>{kSides + 2, 2 * kSides + 1, 2 * kSides + 2}));
}

TEST(MakeCavitySurface, NumbersPointsInTheOrderOfTheirNodes) {
  Matrix3Xd nodes = Matrix3Xd::Zero(3, 8);
  nodes.col(2) << 0.01, 0.0, 0.0;
  nodes.col(7) << 0.0, 0.01, 0.0;
  Eigen::MatrixXi faces(3, 1);
  faces << 7, 4, 2;
  const CavitySurface surface = MakeCavitySurface(SurfaceMesh(nodes, faces));
  EXPECT_EQ(surface.nodes, (std::vector<int>{2, 4, 7}));
  EXPECT_EQ(surface.triangles.col(0), Eigen::Vector3i(2, 0, 1));  // turned: into the material
  EXPECT_EQ(surface.port, std::vector<int>{1});
}

TEST(MakeCavitySurface, TakesTheHighestOfEquallyNearPointsAsPort) {
  Matrix3Xd nodes(3, 3);
  nodes << 0.003, -0.003, 0.01,  //
      0.004, 0.004, 0.0,         // both 5 mm off the axis
      0.001, 0.002, 0.0;
  Eigen::MatrixXi faces(3, 1);
  faces << 0, 1, 2;
  EXPECT_EQ(MakeCavitySurface(SurfaceMesh(nodes, faces)).port, std::vector<int>{1});
}

TEST(MakeCavitySurface, RefusesWhatIsNoDiscLikeSurface) {
  const Matrix3Xd nodes = 0.01 * Matrix3Xd::Random(3, 9);
  const auto refuse = [&](const std::vector<Eigen::Vector3i>& faces, const char* part) {
    Eigen::MatrixXi columns(3, faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) columns.col(static_cast<int>(i)) = faces[i];
    ExpectInvalid([&] { MakeCavitySurface(SurfaceMesh(nodes, columns)); },
                  {"drawn.msh: cavity surface: ", part});
  };
  refuse({}, "no faces");
  refuse({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, "more than two triangles");  // three at the edge 01
  refuse({{0, 1, 2}, {1, 0, 3}, {1, 0, 4}}, "more than two triangles");
  refuse({{0, 1, 2}, {0, 3, 4}}, "touch in node 0 ");  // a bow tie
  refuse({{0, 1, 2}, {3, 4, 5}}, "several pieces");
  refuse({{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}, "closed");  // a whole tetrahedron
  // A ring of six triangles between 0 1 2 and 3 4 5.
  refuse({{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}, {2, 0, 5}, {0, 3, 5}}, "several borders");
}

// One 3-node face, legs 10 mm: a third of 50 mm^2 at each point, against the face's direction.
TEST(PointAreaVectors, SharesATriangleEqually) {
  Eigen::MatrixXi faces(3, 1);
  faces << 0, 1, 2;
  const TetMesh mesh = SurfaceMesh(CubeCorner(0.01), faces);
  const Matrix3Xd areas = PointAreaVectors(MakeCavitySurface(mesh), mesh.nodes);
  ASSERT_EQ(areas.cols(), 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT((areas.col(i) - Vector3d(0.0, 0.0, -0.5e-4 / 3.0)).norm(), 1e-20);
  }
}

// The same face with 6 nodes: four triangles of a quarter each. A corner has one of them, a
// mid-edge node three: A / 12 and A / 4.
TEST(PointAreaVectors, SharesAQuadraticFaceOverFourTriangles) {
  Eigen::MatrixXi faces(6, 1);
  faces << 0, 1, 2, 4, 5, 6;
  const TetMesh mesh = SurfaceMesh(QuadraticCubeCorner(0.01), faces);
  const CavitySurface surface = MakeCavitySurface(mesh);
  const Matrix3Xd areas = PointAreaVectors(surface, mesh.nodes);
  for (int i = 0; i < 6; ++i) {
    const double share = surface.nodes[static_cast<std::size_t>(i)] < 3 ? 1.0 / 12.0 : 0.25;
    EXPECT_LT((areas.col(i) - Vector3d(0.0, 0.0, -0.5e-4 * share)).norm(), 1e-20) << i;
  }
}

// By the divergence theorem the area vectors of any surface that spans a plane loop add up to the
// loop's area along its normal, here n/2 R^2 sin(2 pi / n) upwards, into the material.
TEST(PointAreaVectors, AddUpToTheAreaOfTheLoop) {
  for (const Vector3d& apex :
       {Vector3d(0.0, 0.0, 0.009), Vector3d(0.004, -0.002, 0.009), Vector3d(0.03, 0.01, -0.02)}) {
    const TetMesh mesh = Dome(apex);
    const Vector3d total = PointAreaVectors(MakeCavitySurface(mesh), mesh.nodes).rowwise().sum();
    EXPECT_NEAR(total.z(), PolygonArea(kSides), 1e-17);
    EXPECT_LT(total.head<2>().norm(), 1e-17);

    // Curved faces: their middles on the rim make it a 2 n-gon.
    const TetMesh curved = QuadraticDome(apex);
    const Vector3d sum = PointAreaVectors(MakeCavitySurface(curved), curved.nodes).rowwise().sum();
    EXPECT_NEAR(sum.z(), PolygonArea(2 * kSides), 1e-17);
    EXPECT_LT(sum.head<2>().norm(), 1e-17);
  }
}

TEST(PointAreaVectors, TurnWithTheCupAndIgnoreWhereItIs) {
  const TetMesh mesh = QuadraticDome({0.004, -0.002, 0.009});
  const CavitySurface surface = MakeCavitySurface(mesh);
  const Eigen::Isometry3d X_WM = Eigen::Translation3d(0.3, -0.2, 0.5) *
                                 Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -0.5).normalized());
  const Matrix3Xd areas = PointAreaVectors(surface, X_WM * mesh.nodes);
  EXPECT_LT((areas - X_WM.linear() * PointAreaVectors(surface, mesh.nodes)).norm(), 1e-17);
  const Vector3d total = areas.rowwise().sum();
  EXPECT_LT((total - PolygonArea(2 * kSides) * X_WM.linear().col(2)).norm(), 1e-17);
}

TEST(PointAreaVectors, RefusesTooFewNodes) {
  const CavitySurface surface = MakeCavitySurface(Dome({0.0, 0.0, 0.009}));
  ExpectInvalid([&] { PointAreaVectors(surface, Matrix3Xd::Zero(3, kSides)); }, {"24"});
}

}  // namespace
}  // namespace vacuum_gripper_sim
