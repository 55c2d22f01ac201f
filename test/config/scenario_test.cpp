#include "vacuum_gripper_sim/config/scenario.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

constexpr char kMinimal[] = R"(cup: soft
timeline:
  - {time: 0.0, position: [0.0, 0.0, 0.03]}
  - {time: 0.5, position: [0.0, 0.0, 0.02], pressure_setpoint: -6000.0}
  - {time: 1.0, position: [0.0, 0.0, 0.02]}
)";

class ScenarioFile : public ::testing::Test {
 protected:
  ScenarioFile() {
    WriteCup("soft", "100000.0");
    WriteCup("hard", "900000.0");
    mesh_ = directory_.Write("share/meshes/m.msh", "not read here");
  }
  void WriteCup(const std::string& name, const std::string& young_modulus) const {
    directory_.Write("share/config/cups/" + name + ".yaml",
                     "{name: " + name + ", mesh: ../../meshes/m.msh, young_modulus: " +
                         young_modulus + ", poisson_ratio: 0.45, density: 1080.0}");
  }
  Scenario Read(const std::string& yaml, const std::vector<std::string>& overrides = {}) const {
    return ReadScenario(directory_.Write("case.yaml", yaml), overrides, share());
  }
  std::string Error(const std::string& yaml, const std::vector<std::string>& overrides = {}) const {
    return ErrorOf([&] { Read(yaml, overrides); });
  }
  std::string share() const { return directory_.path() + "/share"; }

  TempDirectory directory_;
  std::string mesh_;
};

TEST_F(ScenarioFile, MinimalOneHasDefaults) {
  const Scenario scenario = Read(kMinimal);
  EXPECT_EQ(scenario.name, "case");
  EXPECT_EQ(scenario.cup.name, "soft");
  EXPECT_EQ(scenario.cup.mesh_file, mesh_);
  EXPECT_EQ(scenario.parameters.material.young_modulus, 100000.0);
  EXPECT_EQ(scenario.duration, 1.0);
  EXPECT_FALSE(scenario.stop_after_loss.has_value());
  EXPECT_EQ(scenario.num_steps(), 100);
  ASSERT_EQ(scenario.objects.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<Plane>(scenario.objects[0].surfaces[0].shape));
  ASSERT_EQ(scenario.timeline.size(), 3U);
  EXPECT_EQ(scenario.timeline[2].pressure_setpoint, -6000.0);
}

TEST_F(ScenarioFile, ReadsSurfaces) {
  const Scenario scenario = Read(std::string(kMinimal) + R"(
surfaces:
  - {name: lid, type: box, size: [0.1, 0.2, 0.3], position: [0.0, 0.0, -0.15]}
  - {type: sphere, radius: 0.04, rotation: [0.0, 0.0, 1.0]}
  - {type: cylinder, radius: 0.05, length: 0.06}
  - {type: plane, rotation: [0.1, 0.0, 0.0]}
)");
  ASSERT_EQ(scenario.objects.size(), 4U);
  EXPECT_EQ(scenario.objects[0].name, "lid");
  EXPECT_EQ(std::get<Box>(scenario.objects[0].surfaces[0].shape).size,
            Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(scenario.objects[0].X_WO.translation(), Eigen::Vector3d(0.0, 0.0, -0.15));
  EXPECT_EQ(std::get<Sphere>(scenario.objects[1].surfaces[0].shape).radius, 0.04);
  EXPECT_EQ(std::get<Cylinder>(scenario.objects[2].surfaces[0].shape).length, 0.06);
}

TEST_F(ScenarioFile, ReadsWhatAirFinds) {
  const Scenario scenario = Read(std::string(kMinimal) + R"(
roughness: 1.0e-6
surfaces:
  - {name: glass, type: plane}
  - name: crate
    type: box
    size: [0.1, 0.1, 0.1]
    roughness: 2.0e-6
    permeance: 3.0e-9
    holes: [{position: [0.01, 0.02, 0.05], area: 4.0e-6}]
)");
  EXPECT_EQ(scenario.objects[0].surfaces[0].roughness, 1e-6);
  const RigidSurface& crate = scenario.objects[1].surfaces[0];
  EXPECT_EQ(crate.roughness, 2e-6);
  EXPECT_EQ(crate.permeance, 3e-9);
  ASSERT_EQ(crate.holes.size(), 1U);
  EXPECT_EQ(crate.holes[0].p_S, Eigen::Vector3d(0.01, 0.02, 0.05));
  EXPECT_EQ(crate.holes[0].area, 4e-6);
  const std::string surface = std::string(kMinimal) + "surfaces: [{type: plane, name: a, ";
  EXPECT_TRUE(Contains(Error(surface + "roughness: -1.0}]"), "surfaces.0.roughness = -1.0"));
  EXPECT_TRUE(Contains(Error(surface + "permeance: -1.0}]"), "permeance = -1"));
  EXPECT_TRUE(Contains(Error(surface + "holes: 1}]"), "surfaces.0.holes = 1"));
  EXPECT_TRUE(Contains(Error(surface + "holes: [{area: 1.0}]}]"), "surfaces.0.holes.0.position"));
}

TEST_F(ScenarioFile, ReadsASceneWithJoints) {
  directory_.Write("scene.urdf",
                   "<robot name=\"s\"><link name=\"world\"/><joint name=\"j\" type=\"fixed\">"
                   "<parent link=\"world\"/><child link=\"plate\"/><origin xyz=\"0 0 -0.1\"/>"
                   "</joint><link name=\"plate\"><collision><origin xyz=\"0 0 0.05\"/><geometry>"
                   "<box size=\"1 1 0.1\"/></geometry></collision></link></robot>");
  const Scenario scenario = Read(std::string(kMinimal) + "scene: scene.urdf\n");
  ASSERT_EQ(scenario.objects.size(), 1U);
  EXPECT_NEAR((scenario.objects[0].X_WO * scenario.objects[0].surfaces[0].X_FS).translation().z(),
              -0.05, 1e-15);
  EXPECT_TRUE(Contains(Error(std::string(kMinimal) + "scene: nothing.urdf\n"), "nothing.urdf"));
  EXPECT_TRUE(Contains(Error(std::string(kMinimal) + "scene: scene.urdf\nsurfaces: []\n"),
                       "scene = scene.urdf"));
}

TEST_F(ScenarioFile, OverridesChangeAnyKey) {
  const Scenario scenario =
      Read(kMinimal, {"time_step=0.002", "timeline.2.time=0.8", "timeline.1.position.2=0.019",
                      "contact.solver=gauss_seidel", "timeline.1.pressure_setpoint=-1.0e+3"});
  EXPECT_EQ(scenario.parameters.time_step, 0.002);
  EXPECT_EQ(scenario.duration, 0.8);
  EXPECT_EQ(scenario.num_steps(), 400);
  EXPECT_EQ(scenario.timeline[1].p_WM.z(), 0.019);
  EXPECT_EQ(scenario.timeline[2].pressure_setpoint, -1000.0);
  EXPECT_EQ(scenario.parameters.contact.method, ContactSolverMethod::kGaussSeidel);
}

TEST_F(ScenarioFile, OverridesReachIntoANamedCup) {
  EXPECT_EQ(Read(kMinimal, {"cup.young_modulus=5.0e+5"}).parameters.material.young_modulus, 5e5);
  const Scenario scenario =
      Read(kMinimal, {"cup=hard", "cup.damping.stiffness=0.5", "cup.material=neo_hookean"});
  EXPECT_EQ(scenario.cup.name, "hard");
  EXPECT_EQ(scenario.parameters.material.young_modulus, 900000.0);
  EXPECT_EQ(scenario.parameters.damping.stiffness, 0.5);
  EXPECT_EQ(scenario.parameters.material.model, MaterialModel::kNeoHookean);
}

TEST_F(ScenarioFile, BadOverridesAreRefused) {
  EXPECT_TRUE(Contains(Error(kMinimal, {"time_step"}), "expected key.path=value"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"=5"}), "expected key.path=value"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"a..b=5"}), "expected key.path=value"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"timeline.3.time=5"}), "expected 0 to 2"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"timeline.last.time=5"}), "last is no index"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"timeline.0.time.x=5"}), "no key x below"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"gravity=[1, 2"}), "--set gravity"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"time_stepp=0.1"}), "time_stepp is not a known key"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"seal.clos_gap=0.1"}), "seal.clos_gap is not a known key"));
  EXPECT_TRUE(
      Contains(Error(kMinimal, {"cup.young_modulis=1"}), "cup.young_modulis is not a known"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"cup=none"}), "cup = none"));
  EXPECT_TRUE(Contains(Error(kMinimal, {"time_step="}), "time_step has no value"));
}

TEST_F(ScenarioFile, RefusalsNameFileAndKey) {
  const std::string minimal = kMinimal;
  for (const auto& [extra, part] : std::vector<std::pair<std::string, std::string>>{
           {"colour: red", "colour is not a known key"},
           {"time_step: soon", "time_step = soon"},
           {"time_step: -0.01", "time_step = -0.01"},
           {"duration: 0.0", "duration = 0.0"},
           {"duration: 1.0e+9", "duration = 1.0e+9"},
           {"stop_after_loss: -0.1", "stop_after_loss = -0.1"},
           {"stop_after_loss: soon", "stop_after_loss = soon"},
           {"gravity: [0.0, 0.0]", "gravity = [0.0, 0.0]"},
           {"seal: {close_gap: 0.1, open_gap: 0.05}", "seal.open_gap"},
           {"regulator: {min_pressure: -5000.0, default_pressure: -1.0}",
            "timeline.1.pressure_setpoint = -6000.0"},
           {"surfaces: {}", "surfaces = {}"},
           {"surfaces: [{name: x}]", "surfaces.0.type is not set"},
           {"surfaces: [{type: cone}]", "surfaces.0.type = cone"},
           {"surfaces: [{type: sphere, radius: -1.0}]", "surfaces.0.radius = -1.0"},
           {"surfaces: [{type: box, size: [1, 1, 0]}]", "surfaces.0.size = [1, 1, 0]"},
           {"surfaces: [{type: plane, radius: 1.0}]", "surfaces.0.radius is not a known key"},
           {"friction: -0.1", "friction = -0.1"},
           {"object_output: maybe", "object_output = maybe"},
           {"motions: {a: []}", "motions is set without scene"},
           {"surfaces: [{type: plane, friction: -1.0}]", "surfaces.0.friction = -1.0"},
           {"surfaces: [{type: plane, mass: 1.0}]", "surfaces.0.mass is set for a plane"},
           {"surfaces: [{type: sphere, radius: 1.0, mass: 0.0}]", "surfaces.0.mass = 0.0"},
           {"surfaces: [{type: sphere, radius: 1.0, mass: heavy}]", "surfaces.0.mass = heavy"},
           {"surfaces: [{type: sphere, radius: 1.0, inertia: [1, 1, 1]}]",
            "surfaces.0.inertia is set without mass"},
           {"surfaces: [{type: sphere, radius: 1.0, mass: 1.0, inertia: [1, 1, 3]}]",
            "surfaces.0: object 'surfaces.0': inertia has the principal"},
           {"surfaces: [{type: plane, velocity: [0, 0, 1]}]", "surfaces.0.velocity is not a known"},
           {"surfaces: [{name: a, type: plane}, {name: a, type: plane}]", "surfaces.1.name = a"},
           {"surfaces: [{type: plane, position: [0, 0, 0], motion: []}]",
            "surfaces.0.position is set and motion too"},
           {"surfaces: [{type: plane, motion: []}]", "surfaces.0.motion = []"},
           {"surfaces: [{type: sphere, radius: 1.0, mass: 1.0, motion: []}]",
            "surfaces.0.motion is set and mass too"},
           {"timeline: []", "timeline is set twice"}}) {
    const std::string error = Error(minimal + extra + "\n");
    EXPECT_TRUE(Contains(error, part)) << extra << ": " << error;
    EXPECT_TRUE(Contains(error, "case.yaml")) << error;
  }
  EXPECT_TRUE(Contains(Error(kMinimal, {"timeline.1.pressure_setpoint=5000.0"}),
                       "timeline.1.pressure_setpoint = 5000.0"));
  EXPECT_TRUE(Contains(Error("timeline: []"), "cup is not set"));
  EXPECT_TRUE(Contains(Error("cup: soft"), "timeline is not set"));
  EXPECT_TRUE(Contains(Error(""), "expected a map of keys"));
  EXPECT_TRUE(Contains(Error("a: 1\nb: [\n"), "case.yaml:3:"));
}

TEST_F(ScenarioFile, ReadsFreeAndMovingObjects) {
  const Scenario scenario = Read(std::string(kMinimal) + R"(friction: 0.5
surfaces:
  - {type: plane}
  - {type: box, size: [0.3, 0.2, 0.1], mass: 1.2, position: [0, 0, 0.05], velocity: [0.1, 0, 0]}
  - {type: cylinder, radius: 0.1, length: 0.2, mass: 3.0, friction: 0.0}
  - {type: sphere, radius: 0.1, mass: 1.0, inertia: [1.0, 2.0, 2.5]}
  - name: plate
    type: box
    size: [1.0, 1.0, 1.0]
    motion:
      - {time: 0.0, position: [0.0, 0.0, 1.0]}
      - {time: 2.0, position: [1.0, 0.0, 1.0]}
)");
  ASSERT_EQ(scenario.objects.size(), 5U);
  EXPECT_FALSE(scenario.objects[0].inertia);
  EXPECT_EQ(scenario.objects[0].surfaces[0].friction, 0.5);
  EXPECT_EQ(scenario.objects[2].surfaces[0].friction, 0.0);
  EXPECT_EQ(scenario.objects[1].velocity_W, Eigen::Vector3d(0.1, 0.0, 0.0));
  const auto moments = [&](std::size_t i) {
    return Eigen::Vector3d(scenario.objects[i].inertia->about_C_O.diagonal());
  };
  // m / 12 (b^2 + c^2): .1 (.04 + .01), .1 (.09 + .01), .1 (.09 + .04).
  EXPECT_TRUE(moments(1).isApprox(Eigen::Vector3d(0.005, 0.010, 0.013), 1e-12));
  // m (3 r^2 + l^2) / 12 = 3 (.03 + .04) / 12, m r^2 / 2.
  EXPECT_TRUE(moments(2).isApprox(Eigen::Vector3d(0.0175, 0.0175, 0.015), 1e-12));
  EXPECT_EQ(moments(3), Eigen::Vector3d(1.0, 2.0, 2.5));
  ASSERT_EQ(scenario.motions.size(), 1U);
  EXPECT_EQ(scenario.motions[0].object, 4);
  EXPECT_EQ(scenario.objects[4].X_WO.translation().z(), 1.0);
  EXPECT_EQ(PoseAt(scenario.motions[0].keyframes, 1.0).translation().x(), 0.5);
  EXPECT_TRUE(scenario.HasMovingObjects());
  EXPECT_FALSE(Read(kMinimal).HasMovingObjects());
}

TEST_F(ScenarioFile, MovesLinksOfAScene) {
  directory_.Write("scene.urdf",
                   "<robot name=\"r\"><link name=\"plate\"><collision><geometry><box size=\"1 1 "
                   "1\"/></geometry></collision></link></robot>");
  const std::string scenario = std::string(kMinimal) + "scene: scene.urdf\n";
  const std::string keyframes = "[{time: 0, position: [0, 0, 2]}, {time: 1, position: [0, 0, 3]}]";
  const Scenario moved = Read(scenario + "motions: {plate: " + keyframes + "}\n");
  ASSERT_EQ(moved.motions.size(), 1U);
  EXPECT_EQ(moved.objects[0].X_WO.translation().z(), 2.0);
  EXPECT_TRUE(Contains(Error(scenario + "motions: {dish: " + keyframes + "}\n"),
                       "motions.dish is no object"));
  EXPECT_TRUE(Contains(Error(scenario + "motions: []\n"), "motions = []"));
}

TEST_F(ScenarioFile, IsFoundByNameAmongTheShipped) {
  const std::string path = directory_.Write("share/config/experiments/pull.yaml", kMinimal);
  EXPECT_EQ(FindScenario("pull", share()), path);
  EXPECT_EQ(FindScenario("some/where.yaml", share()), "some/where.yaml");
  EXPECT_TRUE(Contains(ErrorOf([&] { FindScenario("push", share()); }), "pull"));
  EXPECT_TRUE(Contains(ErrorOf([&] { ReadScenario(share(), {}, share()); }), "not a regular file"));
  EXPECT_TRUE(Contains(ErrorOf([&] { ReadScenario("/no/x.yaml", {}, share()); }), "no such file"));
}

TEST(ShippedScenarios, AreValid) {
  const std::string share = VACUUM_GRIPPER_SOURCE_DIR;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(share + "/config/experiments")) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    EXPECT_EQ(ErrorOf([&] { ReadScenario(entry.path().string(), {}, share); }), "(no error)")
        << entry.path();
  }
  EXPECT_GE(count, 7);
}

TEST(ShippedCups, AreValid) {
  const std::string cups = std::string(VACUUM_GRIPPER_SOURCE_DIR) + "/config/cups";
  const std::map<std::string, double> young_moduli{
      {"a20", 338000.0}, {"a30", 593000.0}, {"flat_25", 2460000.0}, {"bellows_25", 2460000.0}};
  for (const auto& [kind, young_modulus] : young_moduli) {
    for (const std::string& name : {kind, kind + "_linear"}) {
      const Cup cup = ReadCup(YAML::Node(name), cups, cups);
      EXPECT_EQ(cup.name, name);
      EXPECT_TRUE(std::filesystem::exists(cup.mesh_file)) << cup.mesh_file;
      EXPECT_EQ(cup.material.young_modulus, young_modulus);
      EXPECT_EQ(cup.damping.stiffness, RayleighDamping{}.stiffness);
    }
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
