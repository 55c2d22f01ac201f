#include "vacuum_gripper_sim/config/scenario.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "vacuum_gripper_sim/config/simulator_config.h"
#include "vacuum_gripper_sim/config/vacuum_config.h"
#include "vacuum_gripper_sim/config/yaml_file.h"
#include "vacuum_gripper_sim/config/yaml_override.h"
#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxSteps = 1e7;

/// Where a scenario's relative paths start and where the shipped cups are.
struct Directories {
  std::string scenario;
  std::string cups;
};

void ApplyOverrides(const std::vector<std::string>& assignments, const Directories& directories,
                    YAML::Node root) {
  for (const std::string& assignment : assignments) {
    const Override override_ = ParseOverride(assignment);
    const bool below_cup = override_.path.compare(0, 4, "cup.") == 0;
    if (below_cup && std::as_const(root)["cup"].IsDefined() && root["cup"].IsScalar()) {
      root["cup"] = ResolveCup(root["cup"], directories.scenario, directories.cups);
    }
    ApplyOverride(override_, root);
  }
}

SurfaceList ReadWorld(ParameterReader* reader, const Directories& directories) {
  const SurfaceDefaults defaults = ReadSurfaceDefaults(reader);
  const YAML::Node list = reader->GetNode("surfaces");
  if (!reader->Has("scene")) {
    if (reader->Has("motions")) {
      throw std::invalid_argument("motions is set without scene; expected motion in a surface");
    }
    if (reader->Has("surfaces")) {
      return ReadObjects(list, "surfaces", directories.scenario, defaults);
    }
    RigidSurface ground;
    ground.name = "ground";
    ground.shape = Plane{};
    ground.friction = defaults.friction;
    ground.roughness = defaults.roughness;
    return {{FixedObject(ground)}, {}};
  }
  const std::string scene = reader->GetString("scene");
  if (reader->Has("surfaces")) {
    throw std::invalid_argument("scene = " + scene +
                                ": surfaces is set too; expected only one of them");
  }
  const fs::path path = (fs::path(directories.scenario) / scene).lexically_normal();
  SurfaceList world{ReadSceneFile(path.string(), defaults), {}};
  if (!reader->Has("motions")) return world;
  world.motions = ReadMotions(reader->GetNode("motions"), "motions", world.objects);
  for (const ObjectMotion& motion : world.motions) {
    world.objects[static_cast<std::size_t>(motion.object)].X_WO = PoseAt(motion.keyframes, 0.0);
  }
  return world;
}

void CheckSetpoints(const Scenario& scenario, const YAML::Node& timeline) {
  const double lowest = scenario.parameters.regulator.min_pressure;
  for (std::size_t i = 0; i < scenario.timeline.size(); ++i) {
    const double setpoint = scenario.timeline[i].pressure_setpoint;
    if (setpoint <= 0.0 && setpoint >= lowest) continue;
    throw std::invalid_argument(
        "timeline." + std::to_string(i) +
        ".pressure_setpoint = " + Describe(timeline[i]["pressure_setpoint"]) +
        "; expected regulator.min_pressure to 0 [Pa], gauge (negative under suction)");
  }
}

void CheckFaults(const Scenario& scenario) {
  FaultList list = scenario.FaultsAt(-1.0);
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    try {
      list.Apply(scenario.faults[i].command);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument("faults." + std::to_string(i) + "." + e.what());
    }
  }
}

void CheckDuration(const Scenario& scenario, const YAML::Node& value) {
  if (scenario.duration <= 0.0) {
    throw std::invalid_argument("duration = " + Describe(value) + "; expected more than 0 [s]");
  }
  if (scenario.duration / scenario.parameters.time_step > kMaxSteps) {
    throw std::invalid_argument(
        "duration = " + (value.IsNull() ? "the last keyframe's time" : Describe(value)) +
        "; expected at most 10000000 steps of time_step");
  }
}

Scenario ReadDocument(const YAML::Node& root, const Directories& directories,
                      const std::string& default_name) {
  ParameterReader reader(root);
  Scenario scenario;
  scenario.name = reader.GetString("name", default_name);
  reader.GetString("description", "");
  const YAML::Node cup = reader.GetNode("cup");
  SimulatorParameters& parameters = scenario.parameters;
  parameters = ReadSimulatorParameters(&reader);
  parameters.time_step = reader.GetDouble("time_step", parameters.time_step);
  const VacuumSystem vacuum = ReadVacuumSystem(&reader);
  parameters.vacuum = vacuum.parameters;
  scenario.sensor = vacuum.sensor;
  const YAML::Node faults = reader.GetNode("faults");
  const YAML::Node timeline = reader.GetNode("timeline");
  const YAML::Node duration = reader.GetNode("duration");
  const YAML::Node stop_after_loss = reader.GetNode("stop_after_loss");
  reader.GetNode("surfaces");
  reader.GetNode("scene");
  reader.GetNode("motions");
  reader.GetNode("friction");
  reader.GetNode("roughness");
  scenario.object_output = reader.GetBool("object_output", false);
  reader.CheckNoUnknownKeys();  // first: a typo explains most of what follows

  scenario.cup = ReadCup(cup, directories.scenario, directories.cups);
  parameters.material = scenario.cup.material;
  parameters.damping = scenario.cup.damping;
  Validate(parameters);
  SurfaceList world = ReadWorld(&reader, directories);
  scenario.objects = std::move(world.objects);
  scenario.motions = std::move(world.motions);
  if (reader.Has("faults")) {
    scenario.faults = ReadFaultEvents(faults, "faults");
    CheckFaults(scenario);
  }
  scenario.timeline = ReadTimeline(timeline, "timeline");
  CheckSetpoints(scenario, timeline);
  scenario.duration = reader.GetDouble("duration", scenario.timeline.back().time);
  CheckDuration(scenario, duration);
  if (reader.Has("stop_after_loss")) {
    scenario.stop_after_loss = reader.GetDouble("stop_after_loss");
    if (*scenario.stop_after_loss < 0.0) {
      throw std::invalid_argument("stop_after_loss = " + Describe(stop_after_loss) +
                                  "; expected 0 or more [s]");
    }
  }
  return scenario;
}

}  // namespace

int Scenario::num_steps() const {
  // The slack forgives a duration / h that rounds to just above a whole number.
  return static_cast<int>(std::ceil(duration / parameters.time_step - 1e-6));
}

bool Scenario::HasMovingObjects() const {
  const auto is_free = [](const RigidObject& object) { return object.inertia.has_value(); };
  return !motions.empty() || std::any_of(objects.begin(), objects.end(), is_free);
}

FaultList Scenario::FaultsAt(double time) const {
  std::vector<std::string> names;
  names.reserve(objects.size());
  for (const RigidObject& object : objects) names.push_back(object.name);
  FaultList list(parameters, std::move(names));
  // The slack forgives times of steps their rounding.
  for (const FaultEvent& event : faults) {
    if (event.time <= time + 1e-9) list.Apply(event.command);
  }
  return list;
}

std::string FindScenario(const std::string& name, const std::string& share_directory) {
  std::error_code error;
  if (name.find('/') != std::string::npos || fs::is_regular_file(name, error)) return name;
  const fs::path shipped = fs::path(share_directory) / "config" / "experiments";
  if (fs::is_regular_file(shipped / (name + ".yaml"), error)) {
    return (shipped / (name + ".yaml")).string();
  }
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(shipped, error)) {
    if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
  }
  std::string list;
  for (const std::string& known : names) list += ", " + known;
  throw std::invalid_argument(name + ": no such file; expected a scenario's path or one of the " +
                              "experiments that ship with the package" + list);
}

Scenario ReadScenario(const std::string& path, const std::vector<std::string>& overrides,
                      const std::string& share_directory) {
  YAML::Node root = ReadYamlFile(path);
  const fs::path file = fs::absolute(path);
  const Directories directories{file.parent_path().string(),
                                (fs::path(share_directory) / "config" / "cups").string()};
  try {
    ApplyOverrides(overrides, directories, root);
    return ReadDocument(root, directories, file.stem().string());
  } catch (const YAML::Exception& e) {
    // The readers check before they convert; whatever slips through is still one line.
    throw std::invalid_argument(path + ": " + e.msg);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(path + ": " + e.what());
  }
}

}  // namespace vacuum_gripper_sim
