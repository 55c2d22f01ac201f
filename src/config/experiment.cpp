#include "vacuum_gripper_sim/config/experiment.h"

#include <algorithm>
#include <exception>
#include <limits>

#include "vacuum_gripper_sim/core/gmsh_reader.h"

namespace vacuum_gripper_sim {

Simulator MakeSimulator(const Scenario& scenario) {
  Simulator simulator(ReadGmsh(scenario.cup.mesh_file), scenario.parameters,
                      CommandAt(scenario.timeline, 0.0).X_WM);
  simulator.SetObjects(scenario.objects);
  return simulator;
}

ExperimentOutcome RunExperiment(const Scenario& scenario, Simulator* simulator,
                                const std::function<void(const StepResult&)>& observer) {
  const double h = scenario.parameters.time_step;
  SummaryAccumulator accumulator(CommandAt(scenario.timeline, 0.0).X_WM, scenario.objects, h);
  ExperimentOutcome outcome;
  int undone_in_a_row = 0;
  double end = std::numeric_limits<double>::infinity();
  bool over = false;
  const int num_steps = scenario.num_steps();
  auto fault = scenario.faults.begin();
  for (int step = 1; step <= num_steps && !outcome.stopped_early && !over; ++step) {
    const StepResult* result = nullptr;
    try {
      // A command is where the mount shall be at the end of the step; likewise the objects.
      for (const ObjectMotion& motion : scenario.motions) {
        simulator->SetObjectPose(motion.object, PoseAt(motion.keyframes, h * step));
      }
      // They act from the first step on that begins when it is their time.
      const double now = h * (step - 1);
      if (fault != scenario.faults.end() && fault->time <= now + 1e-9) {
        simulator->SetFaults(scenario.FaultsAt(now).ToFaults(simulator->objects()));
        while (fault != scenario.faults.end() && fault->time <= now + 1e-9) ++fault;
      }
      result = &simulator->Step(CommandAt(scenario.timeline, h * step));
    } catch (const std::exception& e) {
      // Not foreseen by Step(); what was recorded up to here must not be lost with it.
      outcome.message = e.what();
      outcome.stopped_early = true;
      break;
    }
    accumulator.Add(*result);
    observer(*result);
    if (scenario.stop_after_loss && result->status == SealStatus::kLost) {
      end = std::min(end, result->time + *scenario.stop_after_loss);
    }
    over = result->time > end - 0.5 * h;
    if (result->outcome == StepOutcome::kOk) {
      undone_in_a_row = 0;
      continue;
    }
    outcome.message = result->message;
    outcome.stopped_early = ++undone_in_a_row >= kMaxUndoneInARow;
  }
  outcome.summary = accumulator.Summary();
  outcome.summary.elements = simulator->mesh().num_elements();
  outcome.summary.nodes = simulator->mesh().num_nodes();
  outcome.summary.seal_close_gap = *simulator->parameters().seal.close_gap;
  outcome.summary.seal_open_gap = *simulator->parameters().seal.open_gap;
  return outcome;
}

}  // namespace vacuum_gripper_sim
