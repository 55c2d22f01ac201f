#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/time.h>

#include <string>

#include "step_times.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/** Counts what the steps did and reports it on /diagnostics.

 Figures are those since the previous report, counters those since the start. Reports go out by wall
 time, so a paused /clock still shows a living node. */
class Diagnostics {
 public:
  /** @param period           Of the reports. [wall s]
      @param time_step        h [s], also the budget of a step.
      @param solver_tolerance Residual above which a step counts as not converged. [m] */
  Diagnostics(const std::string& hardware_id, double period, double time_step,
              double solver_tolerance);

  /// @param met_deadline False if it ended after its period.
  void OnStep(const StepResult& result, const StepCost& cost, bool met_deadline);
  /// The simulation could not be continued and began anew.
  void OnFailure(const std::string& message);
  /// A set-point was accepted, as a message or by a service.
  void OnSetpoint() { setpoint_time_ = ros::WallTime::now(); }
  /// Steps that were skipped because the clock ran away, since the start.
  void SetSkippedSteps(long count) { skipped_ = count; }

  /// How the loop is scheduled, see SchedulingOfThisThread().
  void SetScheduling(const std::string& scheduling) { scheduling_ = scheduling; }

  /// Publishes a report if one is due.
  void Update();

 private:
  struct Window {
    ros::WallTime begin{ros::WallTime::now()};
    int undone{0};
    int unconverged{0};
    int late{0};
    int overlong{0};
    int max_iterations{0};
    double max_residual{0.0};  // [m]
    long skipped{0};           // Counter at the window's begin.
    std::string message;       // Of the last step that was undone.
  };

  void Report(diagnostic_updater::DiagnosticStatusWrapper& status);
  void Summarize(diagnostic_updater::DiagnosticStatusWrapper* status) const;

  ros::WallDuration period_;
  double time_step_;         // [s]
  double solver_tolerance_;  // [m]
  long total_steps_{0};
  long missed_deadlines_{0};
  long late_begins_{0};     // Of the missed ones: steps that took no longer than their period.
  long overlong_steps_{0};  // That computed for longer than their period.
  long undone_steps_{0};
  long skipped_{0};
  unsigned contacts_{0};
  std::string scheduling_;
  ros::WallTime setpoint_time_;
  ros::WallTime next_report_;
  Window window_;
  StepTimes times_;  // In the window.
  diagnostic_updater::Updater updater_;
};

}  // namespace vacuum_gripper_sim
