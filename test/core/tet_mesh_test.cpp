#include "vacuum_gripper_sim/core/tet_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

#include "mesh_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXi;
using Eigen::Vector3d;

// Raw connectivity to spoil: two cube corners of 10 mm that share the face x + y + z = 10 mm, the
// second one's apex being (10, 10, 10) mm. The cavity is the face z = 0, the mount the face x = 0.
struct Raw {
  Matrix3Xd nodes{3, 5};
  MatrixXi elements{4, 2};
  MatrixXi cavity{3, 1};
  MatrixXi mount{3, 1};

  Raw() {
    nodes.leftCols<4>() = CubeCorner(0.01);
    nodes.col(4).setConstant(0.01);
    elements << 0, 4, 1, 2, 2, 1, 3, 3;
    cavity << 0, 1, 2;
    mount << 0, 2, 3;
  }

  TetMesh Make() const { return MakeTetMesh("two.msh", nodes, elements, cavity, mount); }
};

// A 10-node element with a quadratic cavity face z = 0 and mount face x = 0.
struct RawQuadratic {
  Matrix3Xd nodes = QuadraticCubeCorner(0.01);
  MatrixXi elements = Eigen::VectorXi::LinSpaced(10, 0, 9);
  MatrixXi cavity{6, 1};
  MatrixXi mount{6, 1};

  RawQuadratic() {
    cavity << 0, 1, 2, 4, 5, 6;
    mount << 0, 2, 3, 6, 9, 7;
  }

  TetMesh Make() const { return MakeTetMesh("one.msh", nodes, elements, cavity, mount); }
};

Vector3d AreaVector(const TetMesh& mesh, const Eigen::Ref<const Eigen::VectorXi>& face) {
  const Vector3d a = mesh.nodes.col(face(0)), b = mesh.nodes.col(face(1)),
                 c = mesh.nodes.col(face(2));
  return 0.5 * (b - a).cross(c - a);
}

TEST(MakeTetMesh, FindsTheBoundaryOfTwoElements) {
  const TetMesh mesh = Raw().Make();
  EXPECT_EQ(mesh.num_nodes(), 5);
  EXPECT_EQ(mesh.num_elements(), 2);
  EXPECT_FALSE(mesh.quadratic());
  ASSERT_EQ(mesh.boundary_faces.cols(), 6);  // 2 * 4 faces less the shared one, twice
  Vector3d total = Vector3d::Zero();
  for (int f = 0; f < 6; ++f) {
    const Vector3d area = AreaVector(mesh, mesh.boundary_faces.col(f));
    const Vector3d inside = Vector3d::Constant(0.005);
    EXPECT_GT(area.dot(mesh.nodes.col(mesh.boundary_faces(0, f)) - inside), 0.0) << f;
    total += area;
  }
  EXPECT_LT(total.norm(), 1e-19);  // a closed surface
}

TEST(MakeTetMesh, OrientsGroupFacesOutwardsWhateverTheirWinding) {
  Raw raw;
  for (const bool turned : {false, true}) {
    if (turned) raw.cavity.col(0).reverseInPlace();
    const TetMesh mesh = raw.Make();
    ASSERT_EQ(mesh.cavity_faces.cols(), 1);
    const Vector3d area = AreaVector(mesh, mesh.cavity_faces.col(0));
    EXPECT_LT((area - Vector3d(0.0, 0.0, -0.5e-4)).norm(), 1e-19) << turned;
  }
}

TEST(MakeTetMesh, CollectsTheMountsNodes) {
  EXPECT_EQ(Raw().Make().mount_nodes, (std::vector<int>{0, 2, 3}));
  EXPECT_EQ(RawQuadratic().Make().mount_nodes, (std::vector<int>{0, 2, 3, 6, 7, 9}));
}

TEST(MakeTetMesh, PutsMidEdgeNodesBetweenTheirCorners) {
  const TetMesh mesh = RawQuadratic().Make();
  ASSERT_EQ(mesh.boundary_faces.rows(), 6);
  ASSERT_EQ(mesh.boundary_faces.cols(), 4);
  for (int f = 0; f < 4; ++f) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d middle = 0.5 * (mesh.nodes.col(mesh.boundary_faces(k, f)) +
                                     mesh.nodes.col(mesh.boundary_faces((k + 1) % 3, f)));
      EXPECT_LT((mesh.nodes.col(mesh.boundary_faces(3 + k, f)) - middle).norm(), 1e-17);
    }
  }
  EXPECT_LT(AreaVector(mesh, mesh.cavity_faces.col(0)).z(), 0.0);
}

// A file in the mirrored convention: every element has its corners 0 and 1 swapped.
TEST(MakeTetMesh, TurnsAllElementsOfAMirroredMesh) {
  Raw raw;
  raw.elements.row(0).swap(raw.elements.row(1));
  EXPECT_EQ(raw.Make().elements, Raw().elements);

  RawQuadratic quadratic;
  quadratic.elements.col(0) << 1, 0, 2, 3, 4, 6, 5, 8, 7, 9;
  EXPECT_EQ(quadratic.Make().elements, RawQuadratic().elements);
}

TEST(MakeTetMesh, RefusesOneInvertedElement) {
  Raw raw;
  std::swap(raw.elements(0, 1), raw.elements(1, 1));
  ExpectInvalid([&] { raw.Make(); }, {"two.msh: element 1 (from 0)", "inverted", "-2e-06 m^3"});
}

TEST(MakeTetMesh, RefusesADegenerateElement) {
  Raw raw;
  raw.nodes.col(4) << 0.005, 0.005, 1e-19;  // in the plane of the shared face, up to rounding
  ExpectInvalid([&] { raw.Make(); }, {"element 1 (from 0)", "degenerate"});
}

// The middle of the edge 01 moved to 1/5 of it: dx/dxi at corner 0 is 4 (a/5) - a = -a/5 < 0, while
// the volume of the corners is unchanged.
TEST(MakeTetMesh, RefusesAnOverCurvedElement) {
  RawQuadratic raw;
  raw.nodes.col(4) << 0.002, 0.0, 0.0;
  ExpectInvalid([&] { raw.Make(); },
                {"one.msh: element 0 (from 0)", "inverted", "corner 0", "-2e-07 m^3"});
  raw.nodes.col(4) << 0.003, 0.0, 0.0;  // 4 * 0.3 a - a > 0 and at corner 1 3 a - 4 * 0.3 a > 0
  EXPECT_NO_THROW(raw.Make());
}

TEST(MakeTetMesh, RefusesBadNodes) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Raw raw;
    raw.nodes(1, 3) = bad;
    ExpectInvalid([&] { raw.Make(); }, {"two.msh: node 3 (from 0)", "not finite"});
  }
  Raw unused;
  unused.nodes.conservativeResize(3, 6);
  unused.nodes.col(5).setConstant(0.002);
  ExpectInvalid([&] { unused.Make(); }, {"node 5 (from 0) at (0.002", "belongs to no element"});
  for (const int bad : {-1, 5}) {
    Raw unknown;
    unknown.elements(2, 1) = bad;
    ExpectInvalid([&] { unknown.Make(); }, {"element 1 (from 0) names node", "0 .. 4"});
  }
}

TEST(MakeTetMesh, RefusesAMeshInMillimetres) {
  Raw raw;
  raw.nodes *= 1e3;
  ExpectInvalid([&] { raw.Make(); }, {"two.msh", "10 m wide", "at most 1 m", "millimetres"});
}

TEST(MakeTetMesh, RefusesEmptyOrMismatchedInput) {
  Raw raw;
  raw.mount.resize(3, 0);
  ExpectInvalid([&] { raw.Make(); }, {"`mount` is empty"});
  raw = Raw();
  raw.cavity.resize(3, 0);
  ExpectInvalid([&] { raw.Make(); }, {"`cavity` is empty"});
  raw = Raw();
  raw.elements.resize(4, 0);
  ExpectInvalid([&] { raw.Make(); }, {"mesh is empty"});
  raw = Raw();
  raw.elements = MatrixXi::Zero(8, 1);
  ExpectInvalid([&] { raw.Make(); }, {"8 nodes", "4 or 10"});
  raw = Raw();
  raw.cavity = MatrixXi::Zero(6, 1);
  ExpectInvalid([&] { raw.Make(); }, {"`cavity` have 6 nodes, must have 3"});
}

TEST(MakeTetMesh, RefusesGroupFacesThatAreNotOnTheBoundary) {
  Raw raw;
  raw.cavity << 1, 2, 3;  // between the two elements
  ExpectInvalid([&] { raw.Make(); }, {"face 0 (from 0) of group `cavity`", "not on the boundary"});
  raw = Raw();
  raw.mount << 0, 2, 4;  // of no element
  ExpectInvalid([&] { raw.Make(); }, {"group `mount`, nodes 0, 2, 4", "not on the boundary"});
  raw = Raw();
  raw.cavity.resize(3, 2);
  raw.cavity << 0, 1, 1, 2, 2, 0;
  ExpectInvalid([&] { raw.Make(); }, {"face 1 (from 0) of group `cavity`", "twice"});
  RawQuadratic quadratic;
  quadratic.cavity(3, 0) = 9;
  ExpectInvalid([&] { quadratic.Make(); }, {"group `cavity`", "mid-edge"});
}

TEST(MakeTetMesh, RefusesAFaceOfThreeElements) {
  Raw raw;
  raw.nodes.conservativeResize(3, 6);
  raw.nodes.col(5).setConstant(0.02);
  raw.elements.conservativeResize(4, 3);
  raw.elements.col(2) << 5, 2, 1, 3;
  ExpectInvalid([&] { raw.Make(); }, {"nodes 1, 2, 3", "3 elements", "at most 2"});
}

}  // namespace
}  // namespace vacuum_gripper_sim
