#include "vacuum_gripper_sim/core/gmsh_reader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "mesh_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

// The corner of a 10 mm cube; cavity z = 0, mount x = 0. Node numbers have gaps, node 7 belongs to
// an edge only, and a section, a group and lower-dimensional elements are of no interest.
const char kLinear22[] =
    "$MeshFormat\n"            // 1
    "2.2 0 8\n"                // 2
    "$EndMeshFormat\n"         // 3
    "$Comments\n"              // 4
    "made by hand: $Nodes\n"   // 5
    "$EndComments\n"           // 6
    "$PhysicalNames\n"         // 7
    "4\n"                      // 8
    "2 1 \"mount\"\n"          // 9
    "2 2 \"cavity\"\n"         // 10
    "2 3 \"outer side\"\n"     // 11
    "3 1 \"cup\"\n"            // 12
    "$EndPhysicalNames\n"      // 13
    "$Nodes\n"                 // 14
    "5\n"                      // 15
    "7 0.5 0.5 0.5\n"          // 16
    "10 0 0 0\n"               // 17
    "20 0.01 0 0\n"            // 18
    "30 0 1e-2 0\n"            // 19
    "40 0 0 .01\n"             // 20
    "$EndNodes\n"              // 21
    "$Elements\n"              // 22
    "6\n"                      // 23
    "1 15 2 9 9 7\n"           // 24
    "2 1 2 9 9 7 10\n"         // 25
    "3 2 2 1 5 10 30 40\n"     // 26
    "4 2 2 2 6 10 20 30\n"     // 27
    "5 2 2 3 7 20 30 40\n"     // 28
    "6 4 2 1 1 10 20 30 40\n"  // 29
    "$EndElements\n";          // 30

// The same with 10 nodes in Gmsh's order: after the corners the edges 01, 12, 20, 03, 23, 13.
const char kQuadratic22[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n2\n2 1 \"mount\"\n2 2 \"cavity\"\n$EndPhysicalNames\n"
    "$Nodes\n10\n"
    "1 0 0 0\n2 0.01 0 0\n3 0 0.01 0\n4 0 0 0.01\n"
    "5 0.005 0 0\n6 0.005 0.005 0\n7 0 0.005 0\n8 0 0 0.005\n9 0 0.005 0.005\n10 0.005 0 0.005\n"
    "$EndNodes\n"
    "$Elements\n3\n"
    "1 9 2 1 1 1 3 4 7 9 8\n"
    "2 9 2 2 2 1 2 3 5 6 7\n"
    "3 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n"
    "$EndElements\n";

// kLinear22 as version 4.1: groups hang on entities; one node has parametric coordinates.
const char kLinear41[] =
    "$MeshFormat\n"                          // 1
    "4.1 0 8\n"                              // 2
    "$EndMeshFormat\n"                       // 3
    "$PhysicalNames\n"                       // 4
    "3\n"                                    // 5
    "2 1 \"mount\"\n"                        // 6
    "2 2 \"cavity\"\n"                       // 7
    "3 1 \"cup\"\n"                          // 8
    "$EndPhysicalNames\n"                    // 9
    "$Entities\n"                            // 10
    "1 0 3 1\n"                              // 11
    "1 0 0 0 0 \n"                           // 12
    "5 0 0 0 0 0.01 0.01 1 1 0 \n"           // 13
    "6 0 0 0 0.01 0.01 0 1 2 0 \n"           // 14
    "7 0 0 0 0.01 0.01 0 0 0 \n"             // 15
    "1 0 0 0 0.01 0.01 0.01 1 1 3 5 6 7 \n"  // 16
    "$EndEntities\n"                         // 17
    "$Nodes\n"                               // 18
    "2 4 10 40\n"                            // 19
    "2 5 1 1\n"                              // 20
    "10\n"                                   // 21
    "0 0 0 0.5 0.5\n"                        // 22
    "3 1 0 3\n"                              // 23
    "20\n30\n40\n"                           // 24-26
    "0.01 0 0\n0 0.01 0\n0 0 0.01\n"         // 27-29
    "$EndNodes\n"                            // 30
    "$Elements\n"                            // 31
    "4 4 1 4\n"                              // 32
    "2 5 2 1\n1 10 30 40\n"                  // 33-34
    "2 6 2 1\n2 10 20 30\n"                  // 35-36
    "2 7 2 1\n3 20 30 40\n"                  // 37-38
    "3 1 4 1\n4 10 20 30 40\n"               // 39-40
    "$EndElements\n";                        // 41

class ReadGmshTest : public ::testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/gmsh_reader_test.XXXXXX";
    const int file = mkstemp(name);
    ASSERT_GE(file, 0);
    close(file);
    path_ = name;
  }
  void TearDown() override { std::remove(path_.c_str()); }

  TetMesh Read(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return ReadGmsh(path_);
  }

  // Expects a complaint about line `line` of the file.
  void Refuse(const std::string& text, const int line, const char* reason) const {
    const std::string where = path_ + ":" + std::to_string(line) + ": ";
    ExpectInvalid([&] { Read(text); }, {where.c_str(), reason});
  }

  std::string path_;
};

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void ExpectCubeCorner(const TetMesh& mesh) {
  EXPECT_EQ(mesh.nodes, CubeCorner(0.01));
  ASSERT_EQ(mesh.elements.cols(), 1);
  EXPECT_EQ(mesh.elements.col(0), Eigen::Vector4i(0, 1, 2, 3));
  EXPECT_EQ(mesh.boundary_faces.cols(), 4);
  ASSERT_EQ(mesh.cavity_faces.cols(), 1);
  EXPECT_EQ(mesh.cavity_faces.col(0), Eigen::Vector3i(0, 2, 1));
  EXPECT_EQ(mesh.mount_nodes, (std::vector<int>{0, 2, 3}));
}

TEST_F(ReadGmshTest, ReadsVersion22) {
  const TetMesh mesh = Read(kLinear22);
  ExpectCubeCorner(mesh);
  EXPECT_EQ(mesh.source, path_);
}

TEST_F(ReadGmshTest, ReadsVersion41) { ExpectCubeCorner(Read(kLinear41)); }

TEST_F(ReadGmshTest, ReadsLinesWithCarriageReturns) {
  std::string text;
  for (const char c : std::string(kLinear22))
    text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  ExpectCubeCorner(Read(text));
}

TEST_F(ReadGmshTest, TurnsGmshsQuadraticOrderIntoOurs) {
  const TetMesh mesh = Read(kQuadratic22);
  ASSERT_TRUE(mesh.quadratic());
  Eigen::Matrix3Xd in_order(3, 10);
  for (int k = 0; k < 10; ++k) in_order.col(k) = mesh.nodes.col(mesh.elements(k, 0));
  EXPECT_EQ(in_order, QuadraticCubeCorner(0.01));
  EXPECT_EQ(mesh.mount_nodes, (std::vector<int>{0, 2, 3, 6, 7, 8}));
}

// Numbers have a point whatever the process's language; skipped where no such locale is installed.
TEST_F(ReadGmshTest, DoesNotFollowTheLocale) {
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, locale) == nullptr) continue;
    ExpectCubeCorner(Read(kLinear22));
    std::setlocale(LC_ALL, "C");
  }
}

TEST_F(ReadGmshTest, NamesTheMissingGroupAndThoseFound) {
  Refuse(Replaced(kLinear22, "\"mount\"", "\"clamp\""), 22, "`mount` is missing");
  Refuse(Replaced(kLinear22, "\"mount\"", "\"clamp\""), 22, "`clamp`, `cavity`, `outer side`");
  Refuse(Replaced(kLinear22, "2 2 \"cavity\"", "3 2 \"cavity\""), 22, "`cavity` is missing");
  Refuse(Replaced(kLinear41, "\"cavity\"", "\"inner\""), 31, "`cavity` is missing");
  const std::string no_names =
      Replaced(Replaced(kLinear22, "$PhysicalNames", "$Names"), "$EndPhysicalNames", "$EndNames");
  Refuse(no_names, 22, "no named physical surface");
  Refuse(Replaced(kLinear22, "3 2 2 1 5", "3 2 2 3 5"), 30, "`mount` has no triangles");
  Refuse(Replaced(kLinear22, "6 4 2 1 1", "6 4 2 0 1"), 30, "no tetrahedra");
}

TEST_F(ReadGmshTest, RefusesOtherFormats) {
  Refuse(Replaced(kLinear22, "2.2 0 8", "2.1 0 8"), 2, "`2.1`, must be 2.2 or 4.1");
  Refuse(Replaced(kLinear22, "2.2 0 8", "4 0 8"), 2, "must be 2.2 or 4.1");
  Refuse(Replaced(kLinear22, "2.2 0 8", "2.2 1 8"), 2, "binary");
  Refuse(Replaced(kLinear41, "4.1 0 8", "4.1 1 8"), 2, "binary");
  Refuse("solid cup\n", 1, "not a Gmsh mesh");
  Refuse("", 1, "not a Gmsh mesh");
  Refuse(Replaced(kLinear22, "$Nodes\n5", "nodes\n5"), 14, "must be the start of a section");
}

TEST_F(ReadGmshTest, RefusesMissingFilesAndDirectories) {
  ExpectInvalid([] { ReadGmsh("/nonexistent/cup.msh"); },
                {"/nonexistent/cup.msh: cannot be opened: No such file"});
  ExpectInvalid([] { ReadGmsh("/"); }, {"/: cannot be read"});
}

TEST_F(ReadGmshTest, RefusesWhatIsNotAFiniteNumber) {
  Refuse(Replaced(kLinear22, "20 0.01 0 0", "20 nan 0 0"), 18, "is nan, must be finite");
  Refuse(Replaced(kLinear22, "20 0.01 0 0", "20 0.01 -inf 0"), 18, "is -inf, must be finite");
  Refuse(Replaced(kLinear22, "20 0.01 0 0", "20 0.01 1e999 0"), 18, "1e999, must be finite");
  Refuse(Replaced(kLinear22, "20 0.01 0 0", "20 0,01 0 0"), 18, "`0,01`, must be a number");
  Refuse(Replaced(kLinear22, "20 0.01 0 0", "20 0.01 0"), 18, "the line ends before a coordinate");
  Refuse(Replaced(kLinear22, "20 0.01 0 0", "20 0.01 0 0 0"), 18, "unexpected `0`");
  Refuse(Replaced(kLinear22, "20 0.01 0 0", "2x 0.01 0 0"), 18, "`2x`, must be a whole number");
  Refuse(Replaced(kLinear22, "\n5\n7", "\n-5\n7"), 15, "is -5, must be in 0");
  Refuse(Replaced(kLinear22, "\n5\n7", "\n99999999999\n7"), 15, "99999999999, must be in 0");
  Refuse(Replaced(kLinear41, "0.01 0 0\n", "0.01 NaN 0\n"), 27, "is NaN, must be finite");
}

TEST_F(ReadGmshTest, RefusesInconsistentTables) {
  Refuse(Replaced(kLinear22, "30 0 1e-2 0", "20 0 1e-2 0"), 19, "node 20 is there twice");
  Refuse(Replaced(kLinear22, "\n5\n7", "\n4\n7"), 20, "must be $EndNodes");
  Refuse(Replaced(kLinear22, "\n5\n7", "\n6\n7"), 21, "`$EndNodes`, must be a whole number");
  Refuse(Replaced(kLinear22, "10 20 30 40", "10 20 30 50"), 29, "element 6 names node 50");
  Refuse(Replaced(kLinear22, "10 20 30 40", "10 20 30"), 29, "the line ends before");
  Refuse(Replaced(kLinear22, "6 4 2 1 1 10 20 30 40", "6 5 2 1 1 1 2 3 4 5 6 7 8"), 29, "type 5");
  Refuse(Replaced(kLinear22, "4 2 2 2 6 10 20 30", "4 3 2 2 6 10 20 30 40"), 27, "triangle");
  Refuse(Replaced(kQuadratic22, "1 9 2 1 1 1 3 4 7 9 8", "1 2 2 1 1 1 3 4"), 25, "order 2");
  Refuse(Replaced(kLinear41, "3 1 4 1\n4", "3 2 4 1\n4"), 39, "no entity 2 of dimension 3");
  Refuse(Replaced(kLinear41, "2 4 10 40", "2 5 10 40"), 29, "have 4 nodes, must have 5");
  Refuse(Replaced(kLinear41, "4 4 1 4\n", "4 5 1 4\n"), 40, "have 4 elements, must have 5");
}

// Cut anywhere before its end, a file is refused with one line of text.
TEST_F(ReadGmshTest, RefusesATruncatedFile) {
  Refuse(std::string(kLinear22).substr(0, std::string(kLinear22).find("30 0 1e-2")), 18,
         "the file ends within $Nodes");
  Refuse(std::string(kLinear22).substr(0, std::string(kLinear22).find("$EndElements")), 29,
         "the file ends within $Elements");
  for (const std::string text : {kLinear22, kQuadratic22, kLinear41}) {
    for (std::size_t length = 0; length + 1 < text.size(); length += 11) {
      ExpectInvalid([&] { Read(text.substr(0, length)); }, {path_.c_str()});
    }
  }
}

// What is wrong with the mesh itself is MakeTetMesh()'s to say; the reader passes its name on.
TEST_F(ReadGmshTest, RefusesBrokenMeshes) {
  const auto refuse = [this](const std::string& text, const char* reason) {
    ExpectInvalid([&] { Read(text); }, {path_.c_str(), reason});
  };
  refuse(Replaced(kLinear22, "40 0 0 .01", "40 .01 .01 0"), "degenerate");
  refuse(Replaced(kLinear22, "40 0 0 .01", "40 0 0 10"), "millimetres");
  refuse(Replaced(kLinear22, "3 2 2 1 5 10 30 40", "3 2 2 1 5 7 30 40"), "not on the boundary");
  refuse(Replaced(kQuadratic22, "\n5 0.005", "\n5 0.0005"), "inverted");
}

}  // namespace
}  // namespace vacuum_gripper_sim
