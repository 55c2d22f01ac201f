#include "vacuum_gripper_sim/config/experiment_summary.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdint>
#include <sstream>

namespace vacuum_gripper_sim {
namespace {

Eigen::Isometry3d Down(double z) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation().z() = z;
  X.linear() = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0).toRotationMatrix();
  return X;
}

StepResult At(double time, double z, SealStatus status, double force_z, double step_ms = 1.0) {
  StepResult result;
  result.time = time;
  result.X_WM = Down(z);
  result.status = status;
  result.force_M.z() = force_z;
  result.timings.total = 1e-3 * step_ms;
  return result;
}

TEST(ExperimentSummary, FollowsAGripByHand) {
  SummaryAccumulator accumulator(Down(0.030), {}, 0.1);
  accumulator.Add(At(0.1, 0.020, SealStatus::kOpen, -9.0));  // down: pushes hardest
  accumulator.Add(At(0.2, 0.019, SealStatus::kRegulating, -0.3));
  accumulator.Add(At(0.3, 0.019, SealStatus::kSealed, 3.2));
  accumulator.Add(At(0.4, 0.020, SealStatus::kSealed, 4.0));  // the first upward motion
  accumulator.Add(At(0.5, 0.021, SealStatus::kSealed, 4.8));
  accumulator.Add(At(0.6, 0.022, SealStatus::kLost, 0.1));
  accumulator.Add(At(0.7, 0.022, SealStatus::kLost, -0.2));
  const ExperimentSummary summary = accumulator.Summary();
  EXPECT_EQ(summary.sealed_at, 0.2);
  EXPECT_EQ(summary.lost_at, 0.6);
  EXPECT_EQ(summary.hold_force, 3.2);
  EXPECT_EQ(summary.peak_pull_force, 4.8);
  EXPECT_EQ(summary.peak_pull_at, 0.5);
  EXPECT_EQ(summary.seal_flips, 2);
  EXPECT_EQ(summary.steps, 7);
  EXPECT_EQ(summary.undone_steps, 0);
  EXPECT_NEAR(summary.simulated_time, 0.7, 1e-12);
  // 0.7 s in 7 steps of a millisecond.
  EXPECT_NEAR(summary.real_time_factor, 100.0, 1e-9);
}

TEST(ExperimentSummary, CountsEveryFlipAndTheFirstTimes) {
  SummaryAccumulator accumulator(Down(0.0), {}, 1.0);
  const SealStatus sequence[] = {SealStatus::kOpen,       SealStatus::kSealed, SealStatus::kLost,
                                 SealStatus::kRegulating, SealStatus::kSealed, SealStatus::kLost};
  double time = 0.0;
  for (const SealStatus status : sequence) accumulator.Add(At(time += 1.0, 0.0, status, 0.0));
  EXPECT_EQ(accumulator.Summary().seal_flips, 4);
  EXPECT_EQ(accumulator.Summary().sealed_at, 2.0);
  EXPECT_EQ(accumulator.Summary().lost_at, 3.0);
}

TEST(ExperimentSummary, UpIsAgainstTheApproachAxisOfATiltedMount) {
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();  // z of the mount along z of the world
  SummaryAccumulator accumulator(start, {}, 1.0);
  StepResult result;
  result.X_WM = start;
  result.X_WM.translation().z() = 0.1;  // towards the object
  result.force_M.z() = 7.0;
  accumulator.Add(result);
  result.X_WM.translation().x() = 0.1;  // sideways
  accumulator.Add(result);
  EXPECT_FALSE(accumulator.Summary().peak_pull_force.has_value());
  result.X_WM.translation().z() = 0.05;
  result.force_M.z() = -2.0;  // the largest by size, whatever its sign
  accumulator.Add(result);
  EXPECT_EQ(accumulator.Summary().peak_pull_force, 2.0);
}

TEST(ExperimentSummary, StepTimesByRank) {
  SummaryAccumulator accumulator(Down(0.0), {}, 0.01);
  for (int i = 100; i >= 1; --i) accumulator.Add(At(0.0, 0.0, SealStatus::kOpen, 0.0, i));
  EXPECT_NEAR(accumulator.Summary().median_step_ms, 50.5, 1e-9);
  EXPECT_NEAR(accumulator.Summary().p99_step_ms, 99.0, 1e-9);
  accumulator.Add(At(0.0, 0.0, SealStatus::kOpen, 0.0, 1000.0));
  EXPECT_NEAR(accumulator.Summary().median_step_ms, 51.0, 1e-9);
}

TEST(ExperimentSummary, FollowsFreeObjectsAndAveragesEffort) {
  std::vector<RigidObject> objects(2);
  objects[1].name = "box";
  objects[1].inertia = RigidInertia();
  SummaryAccumulator accumulator(Down(0.0), objects, 0.01);
  StepResult result;
  result.objects.resize(2);
  for (const double z : {0.1, 0.3, 0.2}) {
    result.objects[1].X_WO.translation() = Eigen::Vector3d(1.0, 2.0, z);
    result.objects[1].velocity_W = Eigen::Vector3d(0.0, 3.0, 4.0) * z;
    result.friction_force = 1.0 - z;
    result.num_contacts = 4;
    result.num_candidates = static_cast<std::uint32_t>(std::lround(10.0 * z));
    result.solver_iterations = 7;
    accumulator.Add(result);
  }
  const ExperimentSummary summary = accumulator.Summary();
  ASSERT_EQ(summary.free_objects.size(), 1U);
  EXPECT_EQ(summary.free_objects[0].final_position, Eigen::Vector3d(1.0, 2.0, 0.2));
  EXPECT_EQ(summary.free_objects[0].max_height, 0.3);
  EXPECT_NEAR(summary.free_objects[0].max_speed, 1.5, 1e-12);
  EXPECT_EQ(summary.max_friction, 0.9);
  EXPECT_EQ(summary.mean_contacts, 4.0);
  EXPECT_EQ(summary.mean_candidates, 2.0);
  EXPECT_EQ(summary.mean_iterations, 7.0);

  std::ostringstream text;
  WriteSummary(summary, "s", &text);
  const YAML::Node box = YAML::Load(text.str())["free_objects"]["box"];
  EXPECT_EQ(box["final_position"][2].as<double>(), 0.2);
  EXPECT_EQ(box["max_height"].as<double>(), 0.3);
}

TEST(ExperimentSummary, CountsUndoneStepsAndKeepsExtremes) {
  SummaryAccumulator accumulator(Down(0.0), {}, 0.01);
  StepResult result;
  result.max_penetration = 3e-7;
  result.gauge_pressure = -6000.0;
  accumulator.Add(result);
  result.outcome = StepOutcome::kUnconverged;
  result.max_penetration = 1e-7;
  result.gauge_pressure = 0.0;
  accumulator.Add(result);
  EXPECT_EQ(accumulator.Summary().undone_steps, 1);
  EXPECT_EQ(accumulator.Summary().max_penetration, 3e-7);
  EXPECT_EQ(accumulator.Summary().min_gauge_pressure, -6000.0);
}

TEST(ExperimentSummary, IsWrittenAsYaml) {
  ExperimentSummary summary;
  summary.sealed_at = 0.123456789012;
  summary.peak_pull_force = 4.5;
  summary.max_penetration = 1e-7;
  summary.seal_flips = 2;
  std::ostringstream text;
  WriteSummary(summary, "a \"name\": odd", &text);
  const YAML::Node read = YAML::Load(text.str());
  EXPECT_EQ(read["scenario"].as<std::string>(), "a \"name\": odd");
  EXPECT_EQ(read["sealed_at"].as<double>(), 0.123456789012);
  EXPECT_TRUE(read["lost_at"].IsNull());
  EXPECT_EQ(read["peak_pull_force"].as<double>(), 4.5);
  EXPECT_EQ(read["seal_flips"].as<int>(), 2);
  EXPECT_EQ(read["max_penetration"].Scalar(), "1.0e-07");  // a number to YAML 1.1 too
  for (const char* key : {"steps", "median_step_ms", "p99_step_ms", "real_time_factor"}) {
    EXPECT_TRUE(read[key].IsScalar()) << key;
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
