#include "vacuum_gripper_sim/config/cup_file.h"

#include <gtest/gtest.h>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

constexpr char kSoft[] =
    "{name: soft, mesh: ../meshes/m.msh, young_modulus: 100000.0, poisson_ratio: 0.4,"
    " density: 1000.0, damping: {mass: 0.5, stiffness: 0.001}}";

class CupFile : public ::testing::Test {
 protected:
  CupFile() {
    directory_.Write("cups/soft.yaml", kSoft);
    mesh_ = directory_.Write("meshes/m.msh", "not read here");
  }
  Cup Read(const std::string& yaml) const {
    return ReadCup(YAML::Load(yaml), directory_.path() + "/here", directory_.path() + "/cups");
  }
  std::string Error(const std::string& yaml) const {
    return ErrorOf([&] { Read(yaml); });
  }

  TempDirectory directory_;
  std::string mesh_;
};

TEST_F(CupFile, IsFoundByNameAndByPath) {
  for (const char* cup : {"soft", "../cups/soft.yaml"}) {
    const Cup read = Read(cup);
    EXPECT_EQ(read.name, "soft");
    EXPECT_EQ(read.mesh_file, mesh_);
    EXPECT_EQ(read.material.young_modulus, 100000.0);
    EXPECT_EQ(read.material.poisson_ratio, 0.4);
    EXPECT_EQ(read.material.density, 1000.0);
    EXPECT_EQ(read.damping.mass, 0.5);
    EXPECT_EQ(read.damping.stiffness, 0.001);
  }
}

TEST_F(CupFile, MapIsRelativeToTheDirectoryAndKeepsDefaultDamping) {
  const Cup cup =
      Read("{mesh: ../meshes/m.msh, young_modulus: 1.0, poisson_ratio: 0.0, density: 2.0}");
  EXPECT_EQ(cup.mesh_file, mesh_);
  EXPECT_EQ(cup.name, "m");
  EXPECT_EQ(cup.damping.stiffness, RayleighDamping{}.stiffness);
}

TEST_F(CupFile, MaterialIsCorotationalUnlessSaidOtherwise) {
  EXPECT_EQ(Read("soft").material.model, MaterialModel::kCorotational);
  std::string yaml = kSoft;
  yaml.insert(yaml.size() - 1, ", material: neo_hookean");
  EXPECT_EQ(Read(yaml).material.model, MaterialModel::kNeoHookean);
  yaml.replace(yaml.find("neo_hookean"), 11, "corotational");
  EXPECT_EQ(Read(yaml).material.model, MaterialModel::kCorotational);
}

TEST_F(CupFile, RefusesAnUnknownMaterial) {
  for (const char* word : {"neohookean", "1.0", "[1, 2]"}) {
    std::string yaml = kSoft;
    yaml.insert(yaml.size() - 1, std::string(", material: ") + word);
    EXPECT_EQ(Error(yaml),
              std::string("cup.material = ") + word + "; expected corotational or neo_hookean");
  }
}

TEST_F(CupFile, ResolvedCupCanBeChangedAndReadAgain) {
  const std::string cups = directory_.path() + "/cups";
  YAML::Node cup = ResolveCup(YAML::Load("soft"), "/nowhere", cups);
  cup["young_modulus"] = 5.0;
  const Cup read = ReadCup(cup, "/nowhere", cups);
  EXPECT_EQ(read.material.young_modulus, 5.0);
  EXPECT_EQ(read.mesh_file, mesh_);
}

TEST_F(CupFile, RefusalsNameTheKey) {
  EXPECT_TRUE(Contains(Error("hard"), "cup = hard")) << Error("hard");
  EXPECT_TRUE(Contains(Error("hard"), "soft")) << "the message should list the cups that exist";
  EXPECT_TRUE(Contains(Error("no/such.yaml"), "no/such.yaml"));
  EXPECT_TRUE(Contains(Error("[1, 2]"), "cup = [1, 2]"));
  EXPECT_TRUE(Contains(Error(""), "cup is not set"));
  EXPECT_TRUE(Contains(Error("{young_modulus: 1.0}"), "cup.mesh is not set"));
  EXPECT_TRUE(Contains(Error("{mesh: x.msh, young_modulus: 1.0, poisson_ratio: 0.1, density: 1.0}"),
                       "cup.mesh = "));
  EXPECT_TRUE(
      Contains(Error("{mesh: ../meshes/m.msh, young_modulus: hard}"), "cup.young_modulus = hard"));
}

TEST_F(CupFile, RefusesUnknownKeys) {
  std::string yaml = kSoft;
  yaml.insert(yaml.size() - 1, ", colour: red");
  EXPECT_TRUE(Contains(Error(yaml), "cup.colour is not a known key"));
  EXPECT_TRUE(Contains(Error("{mesh: ../meshes/m.msh, young_modulus: 1.0, poisson_ratio: 0.1,"
                             " density: 1.0, damping: {beta: 1.0}}"),
                       "cup.damping.beta is not a known key"));
}

TEST_F(CupFile, SyntaxErrorNamesFileAndLine) {
  directory_.Write("cups/broken.yaml", "name: broken\nmesh: [1, 2\n");
  EXPECT_TRUE(Contains(Error("broken"), "cups/broken.yaml:")) << Error("broken");
}

}  // namespace
}  // namespace vacuum_gripper_sim
