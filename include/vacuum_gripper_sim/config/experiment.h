#pragma once

#include <functional>
#include <string>

#include "vacuum_gripper_sim/config/experiment_summary.h"
#include "vacuum_gripper_sim/config/scenario.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {

/// How an experiment ended.
struct ExperimentOutcome {
  ExperimentSummary summary;
  bool stopped_early{false};  ///< Too many steps in a row were undone, or one threw.
  std::string message;        ///< Of the last step that was undone or threw; empty if none was.

  bool solver_failed() const { return summary.undone_steps > 0 || stopped_early; }
};

/** Makes the simulator that a scenario describes: reads the mesh, places the surfaces and puts the
 mount on its first keyframe.
 @throws std::invalid_argument if mesh or parameters are unusable. */
Simulator MakeSimulator(const Scenario& scenario);

/** Runs a scenario to its end, as fast as it goes. A step that was undone is reported and the next
 one tried; after kMaxUndoneInARow of them in a row the experiment stops.
 @param simulator As from MakeSimulator(); afterwards it holds the final state.
 @param observer  Called after every step. */
ExperimentOutcome RunExperiment(const Scenario& scenario, Simulator* simulator,
                                const std::function<void(const StepResult&)>& observer);

inline constexpr int kMaxUndoneInARow = 10;

}  // namespace vacuum_gripper_sim
