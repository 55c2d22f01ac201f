// The bells' meshes of the package, read as they are.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "support/mesh_volume.h"
#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/gmsh_reader.h"

#ifndef VACUUM_GRIPPER_SOURCE_DIR
#error "VACUUM_GRIPPER_SOURCE_DIR must be the package's directory"
#endif

namespace vacuum_gripper_sim {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Dimensions of config/cups/profiles/bell_*.yaml. [m]
constexpr double kDome = 0.024, kWall = 0.0025, kLip = 0.01875, kBead = 0.00125;
constexpr double kStem = 0.006, kTop = 0.02;

double DomeCentre() { return kBead - std::sqrt(kDome * kDome - kLip * kLip); }

// Three pieces that share no volume, with Ri, Ro the radii of the dome's faces and theta the polar
// angle of the lip seen from the dome's centre at z = c:
//   the shell between the spheres up to theta: 2 pi / 3 (Ro^3 - Ri^3) (1 - cos theta);
//   half the bead, a half disc turned about z; its centroid is 4 b / (3 pi) below the cone theta
//     along the dome's tangent (Pappus): 2 pi (r + 4 b / (3 pi) cos theta) pi b^2 / 2;
//   the stem above the outer sphere: pi s^2 (top - c) - 2 pi / 3 (Ro^3 - (Ro^2 - s^2)^(3/2)).
double BellVolume() {
  const double inner = kDome - kWall / 2.0, outer = kDome + kWall / 2.0;
  const double sine = kLip / kDome, cosine = std::sqrt(1.0 - sine * sine);
  const double shell =
      2.0 * M_PI / 3.0 * (std::pow(outer, 3) - std::pow(inner, 3)) * (1.0 - cosine);
  const double bead = M_PI * M_PI * kBead * kBead * (kLip + 4.0 * kBead / (3.0 * M_PI) * cosine);
  const double stem =
      M_PI * kStem * kStem * (kTop - DomeCentre()) -
      2.0 * M_PI / 3.0 * (std::pow(outer, 3) - std::pow(outer * outer - kStem * kStem, 1.5));
  return shell + bead + stem;
}

/// The bells among the meshes of the package.
std::vector<std::string> BellFiles() {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(VACUUM_GRIPPER_SOURCE_DIR "/meshes")) {
    const bool bell = entry.path().filename().string().rfind("bell_", 0) == 0;
    if (bell && entry.path().extension() == ".msh") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class BellMeshTest : public ::testing::TestWithParam<std::string> {};

TEST_P(BellMeshTest, IsReadInTime) {
  const auto start = std::chrono::steady_clock::now();
  const TetMesh mesh = ReadGmsh(GetParam());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_GT(mesh.num_elements(), 600);
  EXPECT_LT(seconds.count(), 0.3);
}

// Straight edges cut corners with an error of h^2, quadratic ones of h^4; h^3 goes with 1 /
// #elements.
TEST_P(BellMeshTest, HasTheVolumeOfTheBell) {
  const TetMesh mesh = ReadGmsh(GetParam());
  const double size = 1.0 / std::cbrt(mesh.num_elements());
  const double error = 1.0 - Volume(mesh) / BellVolume();
  EXPECT_GT(error, 0.0);  // more of the surface bulges outwards
  EXPECT_LT(error, mesh.quadratic() ? 3.0 * std::pow(size, 4) : 4.0 * std::pow(size, 2));
}

TEST_P(BellMeshTest, HasItsSurfacesWhereTheBellHasThem) {
  const TetMesh mesh = ReadGmsh(GetParam());
  EXPECT_NEAR(mesh.nodes.row(2).minCoeff(), 0.0, 1e-15);
  for (const int node : mesh.mount_nodes) EXPECT_NEAR(mesh.nodes(2, node), kTop, 1e-10);
  const Vector3d centre(0.0, 0.0, DomeCentre());
  int lowest = 0;
  for (const int node : MakeCavitySurface(mesh).nodes) {
    const Vector3d x = mesh.nodes.col(node);
    const double radius = x.head<2>().norm();
    const double off_dome = std::abs((x - centre).norm() - (kDome - kWall / 2.0));
    const double off_bead = std::abs(std::hypot(radius - kLip, x.z() - kBead) - kBead);
    EXPECT_LT(std::min(off_dome, off_bead), 1e-10) << "node " << node;  // mid-edge nodes as well
    if (x.z() == 0.0) {
      EXPECT_NEAR(radius, kLip, 1e-10);
      ++lowest;
    }
  }
  EXPECT_GE(lowest, mesh.quadratic() ? 40 : 20);
}

TEST_P(BellMeshTest, HasOneRimAndItsPortAtTheApex) {
  const TetMesh mesh = ReadGmsh(GetParam());
  const CavitySurface surface = MakeCavitySurface(mesh);
  // The rim is where the bead meets the dome's outer face.
  const double scale = (kDome + kWall / 2.0) / kDome;
  for (const int point : surface.border) {
    const Vector3d x = mesh.nodes.col(surface.nodes[static_cast<std::size_t>(point)]);
    EXPECT_NEAR(x.head<2>().norm(), kLip * scale, 1e-10);
    EXPECT_NEAR(x.z(), DomeCentre() + (kBead - DomeCentre()) * scale, 1e-10);
  }
  ASSERT_EQ(surface.port.size(), 1u);
  const Vector3d apex =
      mesh.nodes.col(surface.nodes[static_cast<std::size_t>(surface.port.front())]);
  EXPECT_LT((apex - Vector3d(0.0, 0.0, DomeCentre() + kDome - kWall / 2.0)).norm(), 1e-10);
}

// The nodes of the rim are a regular polygon in one plane: the area vectors add up to its area.
TEST_P(BellMeshTest, HasAVerticalAreaVectorOfTheRimsSize) {
  const TetMesh mesh = ReadGmsh(GetParam());
  const CavitySurface surface = MakeCavitySurface(mesh);
  std::vector<Vector3d> rim;
  for (const int point : surface.border) {
    rim.push_back(mesh.nodes.col(surface.nodes[static_cast<std::size_t>(point)]));
  }
  std::sort(rim.begin(), rim.end(), [](const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x());
  });
  double area = 0.0;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    area += 0.5 * rim[i].cross(rim[(i + 1) % rim.size()]).z();
  }
  const Vector3d total = PointAreaVectors(surface, mesh.nodes).rowwise().sum();
  EXPECT_NEAR(total.z(), area, 1e-12 * area);
  EXPECT_LT(total.head<2>().norm(), 1e-12 * area);
  if (mesh.quadratic()) {
    const double circle = M_PI * rim[0].head<2>().squaredNorm();
    EXPECT_NEAR(area, circle, 0.005 * circle);
  }
}

INSTANTIATE_TEST_SUITE_P(AllFiles, BellMeshTest, ::testing::ValuesIn(BellFiles()),
                         [](const ::testing::TestParamInfo<std::string>& file) {
                           return std::filesystem::path(file.param).stem().string();
                         });

TEST(BellMeshes, AreThere) { EXPECT_GE(BellFiles().size(), 5u); }

TEST(BellMeshes, LinearAndQuadraticShareTheirSkeleton) {
  for (const std::string size : {"700", "3000"}) {
    const std::string folder = VACUUM_GRIPPER_SOURCE_DIR "/meshes/";
    const TetMesh linear = ReadGmsh(folder + "bell_linear_" + size + ".msh");
    const TetMesh quadratic = ReadGmsh(folder + "bell_quadratic_" + size + ".msh");
    ASSERT_EQ(linear.num_elements(), quadratic.num_elements());
    EXPECT_EQ(linear.elements, quadratic.elements.topRows<4>());
    EXPECT_EQ(linear.nodes, quadratic.nodes.leftCols(linear.num_nodes()));
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
