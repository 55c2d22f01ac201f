// The scenarios of the scenes, each with what it is to show.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/config/experiment.h"
#include "vacuum_gripper_sim/config/scenario.h"

namespace vacuum_gripper_sim {
namespace {

struct Played {
  ExperimentSummary summary;
  std::vector<StepResult> steps;
};

/// Runs a shipped scenario with the linear cup.
Played Play(const std::string& name, std::vector<std::string> overrides = {}) {
  const std::string share = VACUUM_GRIPPER_SOURCE_DIR;
  overrides.insert(overrides.begin(), "cup=a20_linear");
  const Scenario scenario =
      ReadScenario(share + "/config/experiments/" + name + ".yaml", overrides, share);
  Simulator simulator = MakeSimulator(scenario);
  Played run;
  const ExperimentOutcome outcome = RunExperiment(
      scenario, &simulator, [&](const StepResult& result) { run.steps.push_back(result); });
  EXPECT_EQ(outcome.summary.undone_steps, 0) << outcome.message;
  run.summary = outcome.summary;
  return run;
}

TEST(Scenes, ABoxGoesFromTheTableToTheShelf) {
  const Played run = Play("pick_and_place");
  EXPECT_TRUE(run.summary.sealed_at);
  EXPECT_FALSE(run.summary.lost_at);
  EXPECT_EQ(run.steps.back().status, SealStatus::kOpen);
  const FreeObjectSummary& box = run.summary.free_objects.at(0);
  EXPECT_GT(box.max_height, 0.15);
  EXPECT_NEAR(box.final_position.x(), 0.15, 0.002);
  EXPECT_NEAR(box.final_position.y(), 0.0, 0.002);
  EXPECT_NEAR(box.final_position.z(), 0.12, 1e-5);  // on the shelf
  EXPECT_GT(box.max_speed, 0.25);
  // On the shelf nothing of the cup is left on it, and it is at rest.
  EXPECT_EQ(run.steps.back().objects.at(box.index).force_W.norm(), 0.0);
  EXPECT_LT(run.steps.back().objects.at(box.index).velocity_W.norm(), 1e-4);
}

TEST(Scenes, ABottleIsLiftedByItsWall) {
  const Played run = Play("bottle");
  EXPECT_FALSE(run.summary.lost_at);
  const FreeObjectSummary& bottle = run.summary.free_objects.at(0);
  EXPECT_GT(bottle.max_height, 0.11);
  EXPECT_NEAR(bottle.final_position.norm(), 0.0474, 0.003);  // between its wedges again
}

TEST(Scenes, ABallHangsFromATurnedCup) {
  const Played run = Play("ball");
  EXPECT_FALSE(run.summary.lost_at);
  const FreeObjectSummary& ball = run.summary.free_objects.at(0);
  EXPECT_GT(ball.max_height, 0.1);
  EXPECT_NEAR(ball.final_position.z(), 0.035, 1e-5);
  // At 3.8 s the wrist has been turned for a while: cup and weight are in balance, and the weight
  // lies across the cup's axis so much that friction carries a part.
  const StepResult& turned = run.steps.at(379);
  const Eigen::Vector3d force_W = turned.objects.at(ball.index).force_W;
  EXPECT_NEAR(force_W.z(), 0.1 * 9.81, 0.02);
  EXPECT_LT(force_W.head<2>().norm(), 0.02);
  EXPECT_NEAR(std::acos(-turned.X_WM.linear()(2, 2)), M_PI / 3.0, 1e-9);
}

TEST(Scenes, AScannedThingIsLiftedByItsTop) {
  const Played run = Play("scan");
  EXPECT_TRUE(run.summary.sealed_at);
  EXPECT_FALSE(run.summary.lost_at);
  EXPECT_GT(run.summary.free_objects.at(0).max_height, 0.1);
  EXPECT_LT(run.summary.free_objects.at(0).final_position.z(), 0.0335);  // on its feet again
}

TEST(Scenes, OverAnEdgeNothingSeals) {
  const Played run = Play("edge");
  EXPECT_FALSE(run.summary.sealed_at);
  EXPECT_EQ(run.summary.min_gauge_pressure, 0.0);
  std::uint32_t most_contacts = 0;
  for (const StepResult& step : run.steps)
    most_contacts = std::max(most_contacts, step.num_contacts);
  EXPECT_GT(most_contacts, 10U);  // it was pressed on
}

TEST(Scenes, ADraggedPlateSlipsAtMuTimesTheContactForce) {
  const Played run = Play("drag");
  EXPECT_FALSE(run.summary.lost_at);
  const auto ratio = [&](const StepResult& step) {
    return step.objects.at(0).force_W.head<2>().norm() / step.contact_force;
  };
  EXPECT_LT(ratio(run.steps.at(99)), 0.01);                    // at rest
  EXPECT_LT(ratio(run.steps.at(109)), 0.45);                   // still sticks
  EXPECT_NEAR(ratio(run.steps.back()), 0.5, 0.005);            // slides
  EXPECT_LT(run.steps.back().objects.at(0).force_W.x(), 0.0);  // against the plate's way
}

TEST(Scenes, AHeavyPayloadIsLeftOnTheTable) {
  // The linear cup is pulled off at 5 N with or without friction, within a quarter.
  const Played light = Play("payload", {"surfaces.1.mass=0.25"});
  EXPECT_FALSE(light.summary.lost_at);
  EXPECT_GT(light.summary.free_objects.at(0).max_height, 0.025);
  // What hangs weighs what it weighs, on the mount too, less the cup's own weight.
  EXPECT_NEAR(light.steps.back().objects.at(light.summary.free_objects.at(0).index).force_W.z(),
              0.25 * 9.81, 0.02);
  const Played heavy = Play("payload", {"surfaces.1.mass=0.75"});
  EXPECT_TRUE(heavy.summary.lost_at);
  EXPECT_LT(heavy.summary.free_objects.at(0).max_height, 0.0201);
}

}  // namespace
}  // namespace vacuum_gripper_sim
