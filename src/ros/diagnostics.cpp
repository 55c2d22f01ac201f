#include "diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>

namespace vacuum_gripper_sim {
namespace {

// The first second is start-up (memory is touched first, subscribers connect): its late steps are
// not counted.
constexpr double kStartUp = 1.0;  // [s] of simulated time

}  // namespace

Diagnostics::Diagnostics(const std::string& hardware_id, double period, double time_step,
                         double solver_tolerance)
    : period_(period), time_step_(time_step), solver_tolerance_(solver_tolerance) {
  updater_.setHardwareID(hardware_id);
  updater_.add("simulation", this, &Diagnostics::Report);
}

void Diagnostics::OnStep(const StepResult& result, const StepCost& cost, bool met_deadline) {
  ++total_steps_;
  const bool counts = static_cast<double>(total_steps_) * time_step_ > kStartUp;
  if (counts && !met_deadline) {
    ++missed_deadlines_;
    if (cost.wall <= time_step_) ++late_begins_;
    ++window_.late;
  }
  if (counts && cost.computing > time_step_) {
    ++overlong_steps_;
    ++window_.overlong;
  }
  if (result.outcome != StepOutcome::kOk) {
    ++undone_steps_;
    ++window_.undone;
    window_.message = result.message;
  } else if (!(result.solver_residual <= solver_tolerance_)) {
    ++window_.unconverged;
  }
  contacts_ = result.num_contacts;
  window_.max_iterations = std::max(window_.max_iterations, result.solver_iterations);
  window_.max_residual = std::max(window_.max_residual, result.solver_residual);
  times_.Add(cost);
}

void Diagnostics::OnFailure(const std::string& message) {
  ++undone_steps_;
  ++window_.undone;
  window_.message = message;
}

void Diagnostics::Update() {
  const ros::WallTime now = ros::WallTime::now();
  if (now < next_report_) return;
  next_report_ = now + period_;
  updater_.force_update();
}

void Diagnostics::Report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  Summarize(&status);
  const ros::WallTime now = ros::WallTime::now();
  const double elapsed = std::max(1e-9, (now - window_.begin).toSec());
  status.add("step time mean [ms]", 1e3 * times_.Mean());
  status.add("step time 99th percentile [ms]", 1e3 * times_.Percentile(0.99));
  status.add("step time max [ms]", 1e3 * times_.Max());
  status.add("posting share [%]", 1e2 * times_.PostingShare());
  status.add("publishing share [%]", 1e2 * times_.PublishingShare());
  status.add("step budget [ms]", 1e3 * time_step_);
  status.add("scheduling", scheduling_);
  status.add("missed deadlines", missed_deadlines_);
  status.add("missed by steps that only began late", late_begins_);
  status.add("steps computed longer than their period", overlong_steps_);
  status.add("skipped steps", skipped_);
  status.add("real-time factor", times_.count() * time_step_ / elapsed);
  status.add("contacts", contacts_);
  status.add("solver iterations max", window_.max_iterations);
  status.add("solver residual max [m]", window_.max_residual);
  status.add("undone steps", undone_steps_);
  status.add("steps", total_steps_);
  if (setpoint_time_.isZero()) {
    status.add("set-point age [s]", "no set-point yet");
  } else {
    status.add("set-point age [s]", (now - setpoint_time_).toSec());
  }
  window_ = Window();
  times_.Clear();
  window_.skipped = skipped_;
}

void Diagnostics::Summarize(diagnostic_updater::DiagnosticStatusWrapper* status) const {
  using diagnostic_msgs::DiagnosticStatus;
  const long skipped = skipped_ - window_.skipped;
  if (window_.undone > 0) {
    status->summaryf(DiagnosticStatus::ERROR, "%d steps undone, last good state restored: %s",
                     window_.undone, window_.message.c_str());
  } else if (window_.unconverged > 0) {
    status->summaryf(DiagnosticStatus::WARN, "%d steps not converged, residual up to %.3g m",
                     window_.unconverged, window_.max_residual);
  } else if (window_.late > 0 || skipped > 0) {
    status->summaryf(DiagnosticStatus::WARN,
                     "late: %d deadlines missed, %ld steps skipped, %d steps computed for longer "
                     "than their period",
                     window_.late, skipped, window_.overlong);
  } else if (times_.count() == 0) {
    status->summary(DiagnosticStatus::OK, "no step: the clock stands still");
  } else {
    status->summary(DiagnosticStatus::OK, "in time");
  }
}

}  // namespace vacuum_gripper_sim
