// Runs one scenario as fast as it can and writes what happened.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "vacuum_gripper_sim/config/cups_writer.h"
#include "vacuum_gripper_sim/config/experiment.h"
#include "vacuum_gripper_sim/config/experiment_summary.h"
#include "vacuum_gripper_sim/config/objects_writer.h"
#include "vacuum_gripper_sim/config/package_paths.h"
#include "vacuum_gripper_sim/config/scenario.h"
#include "vacuum_gripper_sim/config/sensor_writer.h"
#include "vacuum_gripper_sim/config/timeseries_writer.h"
#include "vacuum_gripper_sim/config/vtu_writer.h"

namespace vacuum_gripper_sim {
namespace {

constexpr int kSuccess = 0;
constexpr int kBadInput = 2;
constexpr int kSolverFailed = 3;

constexpr char kUsage[] =
    "Usage: vacuum_gripper_experiment SCENARIO [--set key=value]... [--out DIR] [--quiet]\n"
    "\n"
    "Runs a scenario of the simulated suction cup as fast as it can.\n"
    "\n"
    "  SCENARIO          a YAML file, or the bare name of one in config/experiments "
    "(pull_off_a20)\n"
    "  --set KEY=VALUE   overrides a key by its dotted path, e.g. cup.young_modulus=593000.0,\n"
    "                    cup=a30, timeline.2.time=0.8; repeatable, applied in order; paths are\n"
    "                    relative to the scenario's file\n"
    "  --out DIR         writes timeseries.csv, summary.yaml, final.vtu, objects.csv if objects\n"
    "                    move, cups.csv of several cups, and sensor.csv of another source than\n"
    "                    the ideal regulator, into DIR (made if it is missing); without it "
    "nothing\n"
    "                    is written\n"
    "  --quiet           prints errors only\n"
    "  --help            prints this\n"
    "\n"
    "Exit status: 0 success, 2 bad input, 3 the solver failed and steps were undone.\n";

struct Arguments {
  std::string scenario;
  std::vector<std::string> overrides;
  std::optional<std::string> out;
  bool quiet{false};
  bool help{false};
};

Arguments ParseArguments(const std::vector<std::string>& words) {
  Arguments arguments;
  const auto value_of = [&words](std::size_t* i) {
    const std::string& option = words[*i];
    if (++*i >= words.size() || words[*i].empty()) {
      throw std::invalid_argument(option + " needs a value; see --help");
    }
    return words[*i];
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--help" || word == "-h") {
      arguments.help = true;
      return arguments;
    }
    if (word == "--set") {
      arguments.overrides.push_back(value_of(&i));
    } else if (word == "--out") {
      arguments.out = value_of(&i);
    } else if (word == "--quiet") {
      arguments.quiet = true;
    } else if (!word.empty() && word[0] == '-') {
      throw std::invalid_argument(word + " is not a known option; see --help");
    } else if (!arguments.scenario.empty()) {
      throw std::invalid_argument(word + ": a second scenario; expected only one (" +
                                  arguments.scenario + ")");
    } else {
      arguments.scenario = word;
    }
  }
  if (arguments.scenario.empty()) {
    throw std::invalid_argument("no scenario given; expected a YAML file or a name, see --help");
  }
  return arguments;
}

/// The files of `--out`, opened before the run: a bad directory is told at once, not after minutes.
class Outputs {
 public:
  Outputs(const std::filesystem::path& directory, const Scenario& scenario) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error) {
      throw std::invalid_argument("--out " + directory.string() +
                                  ": cannot make the directory: " + error.message());
    }
    Open(directory / "timeseries.csv", &timeseries_);
    Open(directory / "summary.yaml", &summary_);
    Open(directory / "final.vtu", &grid_);
    writer_.emplace(&timeseries_);
    if (scenario.HasMovingObjects() || scenario.object_output) {
      Open(directory / "objects.csv", &objects_);
      objects_writer_.emplace(scenario.objects, &objects_);
    }
    if (scenario.parameters.cups.size() > 1) {
      Open(directory / "cups.csv", &cups_);
      cups_writer_.emplace(scenario.parameters.cups, &cups_);
    }
    const VacuumParameters& vacuum = scenario.parameters.vacuum;
    if (vacuum.source != VacuumSourceType::kIdealRegulator) {
      Open(directory / "sensor.csv", &sensor_);
      sensor_writer_.emplace(scenario.sensor, vacuum.ambient_pressure, &sensor_);
    }
  }

  void Write(const Scenario& scenario, const StepResult& result) {
    writer_->Write(result);
    if (objects_writer_) objects_writer_->Write(result);
    if (cups_writer_) cups_writer_->Write(result);
    if (sensor_writer_) {
      sensor_writer_->Write(result, scenario.FaultsAt(result.time).sensor_stuck());
    }
  }

  void Finish(const Scenario& scenario, const ExperimentOutcome& outcome,
              const Simulator& simulator) {
    WriteSummary(outcome.summary, scenario.name, &summary_);
    WriteVtu(simulator.cups(), simulator.result(), &grid_);
    for (std::ofstream* file : {&timeseries_, &summary_, &grid_, &objects_, &cups_, &sensor_}) {
      if (!file->is_open()) continue;  // not asked for
      file->close();
      if (!*file) throw std::runtime_error("--out: the files could not be written (disk full?)");
    }
  }

 private:
  static void Open(const std::filesystem::path& path, std::ofstream* file) {
    file->open(path);
    if (!*file) throw std::invalid_argument("--out: " + path.string() + " cannot be written");
  }

  std::ofstream timeseries_, summary_, grid_, objects_, cups_, sensor_;
  std::optional<TimeseriesWriter> writer_;
  std::optional<ObjectsWriter> objects_writer_;
  std::optional<CupsWriter> cups_writer_;
  std::optional<SensorWriter> sensor_writer_;
};

/// About ten lines a run, at most one each 0.1 s of simulated time.
class Progress {
 public:
  explicit Progress(double duration) : interval_(std::max(0.1, 0.1 * duration)) {}

  void Report(const StepResult& result) {
    if (result.outcome == StepOutcome::kOk && result.time < next_ - 1e-9) return;
    if (result.time >= next_ - 1e-9) next_ += interval_;
    const double force = result.X_WM.linear().col(2).dot(result.X_WM.linear() * result.force_M);
    std::printf(
        "t %7.3f s  mount %8.3f mm  pressure %9.1f Pa  %-10s  force %8.4f N  contacts %3u%s\n",
        result.time, 1e3 * result.X_WM.translation().z(), result.gauge_pressure,
        NameOf(result.status), force, static_cast<unsigned>(result.num_contacts),
        result.outcome == StepOutcome::kOk ? "" : "  UNDONE");
    std::fflush(stdout);
  }

 private:
  double interval_;
  double next_{0.0};
};

/// Exactly one line, whatever the message holds.
int Fail(std::string message, int status) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::cerr << "error: " << message << std::endl;
  return status;
}

int Run(const Arguments& arguments) {
  const std::string share = ShareDirectory();
  const Scenario scenario =
      ReadScenario(FindScenario(arguments.scenario, share), arguments.overrides, share);
  Simulator simulator = MakeSimulator(scenario);
  std::optional<Outputs> outputs;
  if (arguments.out) outputs.emplace(*arguments.out, scenario);
  if (!arguments.quiet) {
    std::printf("%s: %d cup%s %s, %d nodes, %d %s tetrahedra, %d steps of %g s\n",
                scenario.name.c_str(), simulator.cups().num_cups(),
                simulator.cups().num_cups() > 1 ? "s" : "", scenario.cup.name.c_str(),
                simulator.mesh().num_nodes(), simulator.mesh().num_elements(),
                simulator.mesh().quadratic() ? "quadratic" : "linear", scenario.num_steps(),
                scenario.parameters.time_step);
  }

  Progress progress(scenario.duration);
  const ExperimentOutcome outcome =
      RunExperiment(scenario, &simulator, [&](const StepResult& result) {
        if (outputs) outputs->Write(scenario, result);
        if (!arguments.quiet) progress.Report(result);
      });
  if (outputs) outputs->Finish(scenario, outcome, simulator);
  if (!arguments.quiet) WriteSummary(outcome.summary, scenario.name, &std::cout);
  if (!outcome.solver_failed()) return kSuccess;
  return Fail(std::to_string(outcome.summary.undone_steps) + " of " +
                  std::to_string(outcome.summary.steps) + " steps were undone" +
                  (outcome.stopped_early ? " and the run was stopped: " : ", the last one: ") +
                  outcome.message,
              kSolverFailed);
}
}  // namespace
}  // namespace vacuum_gripper_sim

int main(int argc, char** argv) {
  using namespace vacuum_gripper_sim;
  try {
    const Arguments arguments = ParseArguments(std::vector<std::string>(argv + 1, argv + argc));
    if (arguments.help) {
      std::cout << kUsage;
      return kSuccess;
    }
    return Run(arguments);
  } catch (const std::invalid_argument& e) {
    return Fail(e.what(), kBadInput);
  } catch (const std::exception& e) {
    return Fail(e.what(), kSolverFailed);
  }
}
