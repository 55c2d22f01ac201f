// Runs the executable as a user would: files and exit status only. The build passes its path.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

namespace fs = std::filesystem;

// Above the plate, the linear cup: a handful of cheap steps.
constexpr char kHover[] = R"(cup: a20_linear
gravity: [0.0, 0.0, 0.0]
timeline:
  - {time: 0.0, position: [0.0, 0.0, 0.03]}
  - {time: 0.05, position: [0.0, 0.0, 0.029]}
)";

std::string ReadText(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::ptrdiff_t Lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

class ExperimentTool : public ::testing::Test {
 protected:
  /// Runs `executable arguments` in the test's directory; returns the exit status.
  int Run(const std::string& arguments, const std::string& executable = VACUUM_GRIPPER_EXPERIMENT) {
    const std::string out = directory_.path() + "/stdout", err = directory_.path() + "/stderr";
    const int status = std::system(("cd '" + directory_.path() + "' && '" + executable + "' " +
                                    arguments + " > '" + out + "' 2> '" + err + "'")
                                       .c_str());
    stdout_ = ReadText(out);
    stderr_ = ReadText(err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// Bad input: status 2 and exactly one line on stderr that holds `part`.
  void ExpectRefusal(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(Run(arguments), 2) << arguments;
    EXPECT_EQ(Lines(stderr_), 1) << arguments << ": " << stderr_;
    EXPECT_TRUE(Contains(stderr_, part)) << arguments << ": " << stderr_;
  }

  TempDirectory directory_;
  std::string stdout_, stderr_;
};

TEST_F(ExperimentTool, WritesItsThreeFiles) {
  directory_.Write("hover.yaml", kHover);
  ASSERT_EQ(Run("hover.yaml --out a/b"), 0) << stderr_;
  EXPECT_EQ(stderr_, "");
  EXPECT_TRUE(Contains(stdout_, "seal_flips: 0"));
  const std::string out = directory_.path() + "/a/b/";
  EXPECT_EQ(Lines(ReadText(out + "timeseries.csv")), 6);
  EXPECT_EQ(YAML::LoadFile(out + "summary.yaml")["steps"].as<int>(), 5);
  EXPECT_TRUE(Contains(ReadText(out + "final.vtu"), "</VTKFile>"));
}

TEST_F(ExperimentTool, SeveralCupsHaveAFileOfTheirOwn) {
  directory_.Write("hover.yaml", kHover + std::string(R"(cups:
  - {name: left, position: [-0.03, 0.0, 0.0]}
  - {name: right, position: [0.03, 0.0, 0.0]}
)"));
  ASSERT_EQ(Run("hover.yaml --out both"), 0) << stderr_;
  const std::string rows = ReadText(directory_.path() + "/both/cups.csv");
  EXPECT_EQ(Lines(rows), 1 + 2 * 5);
  EXPECT_TRUE(Contains(rows, "\n0.05,right,0,"));
  EXPECT_EQ(Lines(ReadText(directory_.path() + "/both/timeseries.csv")), 6);
  directory_.Write("hover.yaml", kHover);
  ASSERT_EQ(Run("hover.yaml --out one"), 0) << stderr_;
  EXPECT_FALSE(fs::exists(directory_.path() + "/one/cups.csv"));
}

TEST_F(ExperimentTool, QuietPrintsNothingAndHelpPrintsTheUsage) {
  directory_.Write("hover.yaml", kHover);
  EXPECT_EQ(Run("hover.yaml --quiet --set duration=0.01"), 0);
  EXPECT_EQ(stdout_ + stderr_, "");
  EXPECT_EQ(Run("--help"), 0);
  EXPECT_TRUE(Contains(stdout_, "--set"));
}

TEST_F(ExperimentTool, TakesShippedNamesAndOverrides) {
  ASSERT_EQ(Run("pull_off_a20 --set cup=a30_linear --set cup.young_modulus=4.0e+5 "
                "--set duration=0.03 --set time_step=0.005 --out out"),
            0)
      << stderr_;
  EXPECT_EQ(Lines(ReadText(directory_.path() + "/out/timeseries.csv")), 7);
}

TEST_F(ExperimentTool, PrefersTheInstalledFilesBesideIt) {
  const std::string tool = directory_.path() + "/prefix/lib/vacuum_gripper_sim/tool";
  const std::string share = directory_.path() + "/prefix/share/vacuum_gripper_sim";
  directory_.Write("prefix/share/vacuum_gripper_sim/config/experiments/mine.yaml", kHover);
  directory_.Write("prefix/lib/vacuum_gripper_sim/tool", "");
  const fs::path source = VACUUM_GRIPPER_SOURCE_DIR;
  fs::copy(source / "config" / "cups", share + "/config/cups");
  fs::copy(source / "meshes", share + "/meshes");
  fs::copy_file(VACUUM_GRIPPER_EXPERIMENT, tool, fs::copy_options::overwrite_existing);
  EXPECT_EQ(Run("mine --quiet", tool), 0) << stderr_;
}

TEST_F(ExperimentTool, RefusesBadArguments) {
  ExpectRefusal("", "no scenario");
  ExpectRefusal("--fast", "--fast is not a known option");
  ExpectRefusal("a.yaml b.yaml", "b.yaml");
  ExpectRefusal("a.yaml --out", "--out needs a value");
  ExpectRefusal("a.yaml --set", "--set needs a value");
  ExpectRefusal("missing.yaml", "missing.yaml");
  ExpectRefusal("missing", "missing");
  ExpectRefusal("./", "not a regular file");
}

TEST_F(ExperimentTool, RefusesBadScenarios) {
  directory_.Write("syntax.yaml", "cup: a20\ntimeline: [\n");
  ExpectRefusal("syntax.yaml", "syntax.yaml:3:");
  directory_.Write("text.yaml", "just some text");
  ExpectRefusal("text.yaml", "expected a map");
  directory_.Write("hover.yaml", kHover);
  ExpectRefusal("hover.yaml --set colour=red", "colour is not a known key");
  ExpectRefusal("hover.yaml --set time_step=fast", "time_step = fast");
  ExpectRefusal("hover.yaml --set time_step=-1.0", "time_step = -1");
  ExpectRefusal("hover.yaml --set cup.poisson_ratio=0.5", "cup.poisson_ratio = 0.5");
  ExpectRefusal("hover.yaml --set cup.mesh=no.msh", "no.msh");
  ExpectRefusal("hover.yaml --set timeline.1.pressure_setpoint=100.0", "pressure_setpoint = 100.0");
  ExpectRefusal("hover.yaml --set timeline.1.time=0", "timeline.1.time = 0");
  directory_.Write("bad.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  ExpectRefusal("hover.yaml --set cup.mesh=" + directory_.path() + "/bad.msh", "bad.msh");
}

TEST_F(ExperimentTool, RefusesAnOutputDirectoryThatIsAFile) {
  directory_.Write("hover.yaml", kHover);
  directory_.Write("taken", "");
  ExpectRefusal("hover.yaml --out taken", "taken");
}

TEST_F(ExperimentTool, StopsAsLongAfterTheLossAsTheScenarioSays) {
  directory_.Write("pull.yaml", R"(cup: a20_linear
stop_after_loss: 0.05
timeline:
  - {time: 0.0, position: [0.0, 0.0, 0.02]}
  - {time: 0.1, position: [0.0, 0.0, 0.019], pressure_setpoint: -2000.0}
  - {time: 0.3, position: [0.0, 0.0, 0.019]}
  - {time: 1.3, position: [0.0, 0.0, 0.069]}
)");
  ASSERT_EQ(Run("pull.yaml --out out --quiet"), 0) << stderr_;
  const YAML::Node summary = YAML::LoadFile(directory_.path() + "/out/summary.yaml");
  const double lost_at = summary["lost_at"].as<double>();
  EXPECT_LT(lost_at, 1.0);
  EXPECT_NEAR(summary["simulated_time"].as<double>(), lost_at + 0.05, 1e-9);
  EXPECT_EQ(summary["seal_flips"].as<int>(), 2);
}

TEST_F(ExperimentTool, SolverFailureGivesThreeAndStillWrites) {
  directory_.Write("hover.yaml", kHover);
  // One sweep of Gauss-Seidel for a cup driven into the plate never gets to a nanometre.
  EXPECT_EQ(Run("hover.yaml --out out --set timeline.1.position.2=0.015 --set duration=1.0 "
                "--set contact.solver=gauss_seidel --set contact.max_iterations=1 "
                "--set contact.tolerance=1.0e-12 --set contact.acceptable_residual=1.0e-12"),
            3)
      << stderr_;
  EXPECT_EQ(Lines(stderr_), 1) << stderr_;
  const YAML::Node summary = YAML::LoadFile(directory_.path() + "/out/summary.yaml");
  EXPECT_GE(summary["undone_steps"].as<int>(), 10);
  EXPECT_LT(summary["steps"].as<int>(), 100);  // stopped, not dragged to the end
  EXPECT_TRUE(Contains(ReadText(directory_.path() + "/out/final.vtu"), "</VTKFile>"));
}

}  // namespace
}  // namespace vacuum_gripper_sim
