#include "vacuum_gripper_sim/config/experiment_summary.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <locale>
#include <sstream>

namespace vacuum_gripper_sim {
namespace {

// Motions below this are the rounding of a mount that holds still. [m]
constexpr double kMotionTolerance = 1e-12;

double Median(const std::vector<double>& sorted) {
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

double Percentile(const std::vector<double>& sorted, double fraction) {
  const auto rank =
      static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

std::string Number(const std::optional<double>& value) {
  if (!value.has_value()) return "null";
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(12);
  text << *value;
  std::string number = text.str();
  // What YAML 1.1 takes for text without it.
  const std::size_t exponent = number.find('e');
  if (exponent != std::string::npos && number.find('.') == std::string::npos) {
    number.insert(exponent, ".0");
  }
  return number;
}

std::string Quoted(const std::string& text) {
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << text;
  return emitter.c_str();
}

}  // namespace

SummaryAccumulator::SummaryAccumulator(const Eigen::Isometry3d& X_WM,
                                       const std::vector<RigidObject>& objects, double time_step)
    : time_step_(time_step), X_WM_(X_WM) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].inertia) continue;
    FreeObjectSummary object;
    object.name = objects[i].name;
    object.index = i;
    object.final_position = objects[i].X_WO.translation();
    object.max_height = object.final_position.z();
    summary_.free_objects.push_back(object);
  }
}

void SummaryAccumulator::Add(const StepResult& result) {
  ++summary_.steps;
  if (result.outcome != StepOutcome::kOk) ++summary_.undone_steps;
  summary_.max_penetration = std::max(summary_.max_penetration, result.max_penetration);
  summary_.min_gauge_pressure = std::min(summary_.min_gauge_pressure, result.gauge_pressure);
  summary_.max_friction = std::max(summary_.max_friction, result.friction_force);
  summary_.mean_contacts += result.num_contacts;
  summary_.mean_candidates += result.num_candidates;
  summary_.mean_iterations += result.solver_iterations;
  step_ms_.push_back(1e3 * result.timings.total);
  AddSeal(result);
  AddForce(result);
  AddObjects(result);
}

void SummaryAccumulator::AddSeal(const StepResult& result) {
  const bool holds = Holds(result.status);
  if (holds != holds_) ++summary_.seal_flips;
  if (holds && !summary_.sealed_at) summary_.sealed_at = result.time;
  if (result.status == SealStatus::kLost && status_ != SealStatus::kLost && !summary_.lost_at) {
    summary_.lost_at = result.time;
  }
  holds_ = holds;
  status_ = result.status;
}

void SummaryAccumulator::AddForce(const StepResult& result) {
  const Eigen::Vector3d motion = result.X_WM.translation() - X_WM_.translation();
  if (motion.dot(X_WM_.linear().col(2)) < -kMotionTolerance) pulled_ = true;
  X_WM_ = result.X_WM;
  const double force = std::abs(result.force_M.z());
  if (!pulled_) {
    summary_.hold_force = force;
  } else if (!summary_.peak_pull_force || force > *summary_.peak_pull_force) {
    summary_.peak_pull_force = force;
    summary_.peak_pull_at = result.time;
  }
}

void SummaryAccumulator::AddObjects(const StepResult& result) {
  for (FreeObjectSummary& object : summary_.free_objects) {
    const ObjectResult& now = result.objects.at(object.index);
    object.final_position = now.X_WO.translation();
    object.max_height = std::max(object.max_height, object.final_position.z());
    object.max_speed = std::max(object.max_speed, now.velocity_W.norm());
  }
}

ExperimentSummary SummaryAccumulator::Summary() const {
  ExperimentSummary summary = summary_;
  if (step_ms_.empty()) return summary;
  std::vector<double> sorted = step_ms_;
  std::sort(sorted.begin(), sorted.end());
  summary.median_step_ms = Median(sorted);
  summary.p99_step_ms = Percentile(sorted, 0.99);
  for (double* mean :
       {&summary.mean_contacts, &summary.mean_candidates, &summary.mean_iterations}) {
    *mean /= summary.steps;
  }
  summary.simulated_time = time_step_ * summary.steps;
  double wall = 0.0;
  for (const double ms : step_ms_) wall += 1e-3 * ms;
  summary.real_time_factor = wall > 0.0 ? summary.simulated_time / wall : 0.0;
  return summary;
}

void WriteSummary(const ExperimentSummary& summary, const std::string& scenario,
                  std::ostream* stream) {
  *stream << "scenario: " << Quoted(scenario) << '\n'
          << "sealed_at: " << Number(summary.sealed_at) << "  # s\n"
          << "lost_at: " << Number(summary.lost_at) << "  # s\n"
          << "hold_force: " << Number(summary.hold_force) << "  # N\n"
          << "peak_pull_force: " << Number(summary.peak_pull_force) << "  # N\n"
          << "peak_pull_at: " << Number(summary.peak_pull_at) << "  # s\n"
          << "seal_flips: " << std::to_string(summary.seal_flips) << '\n'
          << "steps: " << std::to_string(summary.steps) << '\n'
          << "undone_steps: " << std::to_string(summary.undone_steps) << '\n'
          << "max_penetration: " << Number(summary.max_penetration) << "  # m\n"
          << "max_friction: " << Number(summary.max_friction) << "  # N\n"
          << "mean_contacts: " << Number(summary.mean_contacts) << '\n'
          << "mean_candidates: " << Number(summary.mean_candidates) << '\n'
          << "mean_iterations: " << Number(summary.mean_iterations) << '\n'
          << "min_gauge_pressure: " << Number(summary.min_gauge_pressure) << "  # Pa\n"
          << "elements: " << std::to_string(summary.elements) << '\n'
          << "nodes: " << std::to_string(summary.nodes) << '\n'
          << "seal_close_gap: " << Number(summary.seal_close_gap) << "  # m\n"
          << "seal_open_gap: " << Number(summary.seal_open_gap) << "  # m\n"
          << "simulated_time: " << Number(summary.simulated_time) << "  # s\n"
          << "median_step_ms: " << Number(summary.median_step_ms) << '\n'
          << "p99_step_ms: " << Number(summary.p99_step_ms) << '\n'
          << "real_time_factor: " << Number(summary.real_time_factor) << '\n';
  if (summary.free_objects.empty()) return;
  *stream << "free_objects:\n";
  for (const FreeObjectSummary& object : summary.free_objects) {
    const Eigen::Vector3d& p = object.final_position;
    *stream << "  " << Quoted(object.name) << ":\n"
            << "    final_position: [" << Number(p.x()) << ", " << Number(p.y()) << ", "
            << Number(p.z()) << "]  # m\n"
            << "    max_height: " << Number(object.max_height) << "  # m\n"
            << "    max_speed: " << Number(object.max_speed) << "  # m/s\n";
  }
}

}  // namespace vacuum_gripper_sim
