#include "vacuum_gripper_sim/config/mesh_file.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>

#include "config_test_tools.h"
#include "support/surface_meshes.h"
#include "vacuum_gripper_sim/config/package_paths.h"
#include "vacuum_gripper_sim/config/scene_urdf.h"
#include "vacuum_gripper_sim/config/surface_list.h"
#include "vacuum_gripper_sim/config/yaml_file.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

const Vector3d kSize(0.3, 0.2, 0.1);
const Vector3d kOnes = Vector3d::Ones();

std::string AsciiStl(const Triangles& mesh) {
  std::ostringstream text;
  text << "solid thing\n";
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    text << "facet normal 0 0 0\n outer loop\n";
    for (int k = 0; k < 3; ++k) {
      text << "  vertex " << mesh.vertices.col(mesh.triangles(k, t)).transpose() << '\n';
    }
    text << " endloop\nendfacet\n";
  }
  text << "endsolid thing\n";
  return text.str();
}

template <typename Number>
void Put(Number number, std::string* bytes) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof(Number));
  bytes->append(raw, sizeof(Number));
}

std::string BinaryStl(const Triangles& mesh) {
  std::string bytes(80, ' ');
  Put(static_cast<std::uint32_t>(mesh.triangles.cols()), &bytes);
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) Put(0.0F, &bytes);
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        Put(static_cast<float>(mesh.vertices(axis, mesh.triangles(k, t))), &bytes);
      }
    }
    Put(std::uint16_t{0}, &bytes);
  }
  return bytes;
}

std::string Obj(const Triangles& mesh) {
  std::ostringstream text;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    text << "v " << mesh.vertices.col(v).transpose() << '\n';
  }
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    text << "f " << (mesh.triangles.col(t).array() + 1).transpose() << '\n';
  }
  return text.str();
}

/// One triangle mesh below a node with a pose of its own.
std::string Dae(const Triangles& mesh, const std::string& up_axis, const std::string& metres,
                const std::string& node) {
  std::ostringstream text;
  text << R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="unit" meter=")"
       << metres << R"("/><up_axis>)" << up_axis << R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count=")"
       << mesh.vertices.size() << R"(">)";
  for (Eigen::Index i = 0; i < mesh.vertices.size(); ++i) text << mesh.vertices.data()[i] << ' ';
  text << R"(</float_array><technique_common><accessor source="#a" count=")" << mesh.vertices.cols()
       << R"(" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count=")"
       << mesh.triangles.cols() << R"("><input semantic="VERTEX" source="#v" offset="0"/><p>)";
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i) text << mesh.triangles.data()[i] << ' ';
  text << R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">)"
       << node << R"(<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
  return text.str();
}

void ExpectBounds(const TriangleMesh& mesh, const Vector3d& lower, const Vector3d& upper) {
  EXPECT_LT((mesh.bounds().min() - lower).norm(), 1e-7) << mesh.bounds().min().transpose();
  EXPECT_LT((mesh.bounds().max() - upper).norm(), 1e-7) << mesh.bounds().max().transpose();
}

TEST(MeshFile, ReadsEveryFormat) {
  const TempDirectory directory;
  const Triangles box = MakeBoxMesh(2, kSize);
  directory.Write("ascii.stl", AsciiStl(box));
  directory.Write("binary.STL", BinaryStl(box));
  directory.Write("box.obj", Obj(box));
  directory.Write("box.dae", Dae(box, "Z_UP", "1", ""));
  MeshFiles files(directory.path());
  for (const char* const name : {"ascii.stl", "binary.STL", "box.obj", "box.dae"}) {
    SCOPED_TRACE(name);
    const Mesh mesh = files.Load("mesh", name, kOnes);
    EXPECT_EQ(mesh->num_triangles(), 48);
    EXPECT_EQ(mesh->vertices().cols(), 26);
    EXPECT_TRUE(mesh->closed());
    ExpectBounds(*mesh, -0.5 * kSize, 0.5 * kSize);
    EXPECT_NEAR(mesh->Nearest(Vector3d::Zero())->distance, -0.05, 1e-7);
  }
}

TEST(MeshFile, PolygonsBecomeTriangles) {
  const TempDirectory directory;
  directory.Write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 3\nf 1 2 3 4\n");
  const Mesh mesh = MeshFiles(directory.path()).Load("mesh", "quad.obj", kOnes);
  EXPECT_EQ(mesh->num_triangles(), 2);
  EXPECT_FALSE(mesh->closed());
  EXPECT_EQ(mesh->normal(0), Vector3d::UnitZ());
}

// rviz places a DAE's nodes and turns its lengths into metres, and leaves its axes as they are.
TEST(MeshFile, DaeNodesAndUnitsButNoUpAxis) {
  const TempDirectory directory;
  const Triangles box = MakeBoxMesh(1, 100.0 * kSize);
  const std::string node = "<translate>50 0 0</translate><rotate>0 0 1 90</rotate>";
  for (const char* const up : {"X_UP", "Y_UP", "Z_UP"}) {
    SCOPED_TRACE(up);
    const std::string file = std::string(up) + ".dae";
    directory.Write(file, Dae(box, up, "0.01", node));
    const Mesh mesh = MeshFiles(directory.path()).Load("mesh", file, kOnes);
    ExpectBounds(*mesh, {0.4, -0.15, -0.05}, {0.6, 0.15, 0.05});
  }
}

TEST(MeshFile, ScalesAndMirrors) {
  const TempDirectory directory;
  Triangles box = MakeBoxMesh(1, 1000.0 * kSize);
  box.vertices.row(0).array() += 1000.0;
  const std::string path = directory.Write("box.stl", BinaryStl(box));
  MeshFiles files;
  ExpectBounds(*files.Load("mesh", path, 1e-3 * kOnes), {0.85, -0.1, -0.05}, {1.15, 0.1, 0.05});
  const Mesh mirrored = files.Load("mesh", path, {-1e-3, 1e-3, 2e-3});
  ExpectBounds(*mirrored, {-1.15, -0.1, -0.1}, {-0.85, 0.1, 0.1});
  EXPECT_LT(mirrored->Nearest({-1.0, 0.0, 0.0})->distance, 0.0);
  EXPECT_EQ(mirrored->turned_triangles(), 0);
  directory.Write("sheet.stl", BinaryStl(MakeSheet(1, 1.0)));
  const Mesh sheet = MeshFiles(directory.path()).Load("mesh", "sheet.stl", {-1.0, 1.0, 1.0});
  EXPECT_EQ(sheet->normal(0), Vector3d::UnitZ());  // its front is still up
}

TEST(MeshFile, FindsFilesByEveryUriAndReadsThemOnce) {
  const TempDirectory directory;
  const std::string path =
      directory.Write("stack/things/meshes/box.stl", BinaryStl(MakeBoxMesh(1, kSize)));
  directory.Write("stack/things/package.xml", "<package>\n <name> odd_things </name></package>");
  MeshFiles files(directory.path() + "/stack");
  const Mesh mesh = files.Load("mesh", "things/meshes/box.stl", kOnes);
  EXPECT_EQ(files.Load("mesh", path, kOnes), mesh);
  EXPECT_EQ(files.Load("mesh", "file://" + path, kOnes), mesh);
  EXPECT_NE(files.Load("mesh", path, 2.0 * kOnes), mesh);
  const char* const before = std::getenv("ROS_PACKAGE_PATH");
  const std::string saved = before == nullptr ? "" : before;
  setenv("ROS_PACKAGE_PATH", ("/nowhere:" + directory.path()).c_str(), 1);
  EXPECT_EQ(files.Load("mesh", "package://odd_things/meshes/box.stl", kOnes), mesh);
  EXPECT_EQ(PackageDirectory("no_such_things"), "");
  setenv("ROS_PACKAGE_PATH", saved.c_str(), 1);
  EXPECT_EQ(PackageDirectory("vacuum_gripper_sim"), ShareDirectory());
}

TEST(MeshFile, EveryMistakeIsOneLineWithFieldAndUri) {
  const TempDirectory directory;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Triangles bad = MakeBoxMesh(1, kSize);
  directory.Write("good.stl", BinaryStl(bad));
  directory.Write("millimetres.stl", BinaryStl(MakeBoxMesh(1, 1000.0 * kSize)));
  bad.vertices(1, 3) = nan;
  directory.Write("nan.stl", BinaryStl(bad));
  directory.Write("empty.stl", "solid nothing\nendsolid nothing\n");
  directory.Write("empty.obj", "v 0 0 0\n");
  directory.Write("noise.dae", "<COLLADA><mesh>\nwhat\nis");
  directory.Write("cut.stl", BinaryStl(MakeBoxMesh(1, kSize)).substr(0, 300));
  directory.Write("thing.step", "ISO-10303-21;");
  const auto error = [&](const std::string& uri, const Vector3d& scale = kOnes) {
    return ErrorOf([&] { MeshFiles(directory.path()).Load("link bowl: mesh", uri, scale); });
  };
  const auto expect = [](const std::string& message, const std::string& uri,
                         const std::string& part) {
    EXPECT_TRUE(Contains(message, "link bowl: mesh = " + uri)) << message;
    EXPECT_TRUE(Contains(message, part)) << message;
    EXPECT_FALSE(Contains(message, "\n")) << message;
  };
  for (const auto& [uri, part] : std::vector<std::pair<std::string, std::string>>{
           {"http://x.org/a.stl", "unknown scheme http://; expected package://, file:// or a path"},
           {"package://no_such_package/a.stl", "no package 'no_such_package'"},
           {"package://", "no package ''"},
           {"package://vacuum_gripper_sim/none.stl", "no such file"},
           {"file://relative.stl", "three slashes"},
           {"file:///none.stl", "no such file /none.stl"},
           {"none.stl", "no such file " + directory.path() + "/none.stl"},
           {"", "no such file"},
           {"thing.step", "'.step'; expected .stl, .obj or .dae"},
           {"millimetres.stl", "300 m wide, must be at most 10 m"},
           {"nan.stl", "vertex"},
           {"empty.stl", "no triangles"},
           {"empty.obj", "cannot be read"},
           {"noise.dae", "cannot be read"},
           {"cut.stl", "cannot be read"}}) {
    expect(error(uri), uri, part);
  }
  expect(error("good.stl", {1.0, 0.0, 1.0}), "good.stl", "scale = 1 0 1");
  expect(error("good.stl", {1.0, nan, 1.0}), "good.stl", "scale = 1 nan 1");
  EXPECT_TRUE(Contains(ErrorOf([] { MeshFiles().Load("mesh", "a.stl", kOnes); }), "relative path"));
}

TEST(MeshFile, TheScannedThingThatShipsIsASolid) {
  const Mesh mesh = MeshFiles().Load(
      "mesh", "package://vacuum_gripper_sim/meshes/scenes/scanned_thing.stl", kOnes);
  EXPECT_EQ(mesh->num_triangles(), 5120);
  EXPECT_TRUE(mesh->closed());
  EXPECT_EQ(mesh->num_shells(), 1);
  EXPECT_EQ(mesh->turned_triangles(), 0);
  EXPECT_LT(mesh->Nearest(Vector3d::Zero())->distance, -0.02);
  EXPECT_LT(mesh->bounds().sizes().maxCoeff(), 0.1);
}

TEST(MeshFile, InScenesAndLists) {
  const TempDirectory directory;
  directory.Write("box.stl", BinaryStl(MakeBoxMesh(1, 1000.0 * kSize)));
  const std::string scene = directory.Write(
      "scene.urdf",
      "<robot name=\"r\"><link name=\"bowl\"><collision><origin xyz=\"0 0 0.5\"/><geometry>"
      "<mesh filename=\"box.stl\" scale=\"0.001 0.001 0.001\"/></geometry></collision></link>"
      "</robot>");
  const std::vector<RigidObject> objects = ReadSceneFile(scene);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].name, "bowl");
  EXPECT_NEAR(Distance(objects[0].surfaces[0], {0.0, 0.0, 0.75}).distance, 0.2, 1e-7);
  EXPECT_TRUE(Contains(ErrorOf([&] { ReadSceneUrdf(ReadTextFile(scene)); }),
                       "scene: link bowl: mesh filename = box.stl: a relative path"));

  const YAML::Node list = YAML::Load(
      "[{name: a, type: mesh, file: box.stl, scale: [0.001, 0.001, 0.001]},"
      " {name: b, type: mesh, file: box.stl, scale: [0.001, 0.001, 0.001]}]");
  const std::vector<RigidObject> pair = ReadObjects(list, "surfaces", directory.path()).objects;
  ASSERT_EQ(pair.size(), 2U);
  EXPECT_EQ(std::get<Mesh>(pair[0].surfaces[0].shape),
            std::get<Mesh>(pair[1].surfaces[0].shape));  // one geometry
  const YAML::Node bad = YAML::Load("[{type: mesh, file: box.stl}]");
  EXPECT_TRUE(Contains(ErrorOf([&] { ReadObjects(bad, "surfaces", directory.path()); }),
                       "surfaces.0.file = box.stl: the mesh is 300 m wide"));
}

}  // namespace
}  // namespace vacuum_gripper_sim
