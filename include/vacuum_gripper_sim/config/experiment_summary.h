#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_object.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/// What became of a free object.
struct FreeObjectSummary {
  std::string name;
  std::size_t index{0};                                     ///< Of StepResult::objects.
  Eigen::Vector3d final_position{Eigen::Vector3d::Zero()};  ///< Of its frame, world. [m]
  double max_height{0.0};                                   ///< Largest z of its frame. [m]
  double max_speed{0.0};                                    ///< Of its frame. [m/s]
};

/// The figures of one experiment. Empty where the event did not happen.
struct ExperimentSummary {
  std::optional<double> sealed_at;   ///< First time the grip held, see Holds(). [s]
  std::optional<double> lost_at;     ///< First time the status became LOST. [s]
  std::optional<double> hold_force;  ///< |Force along the approach axis| in the last step before
                                     ///< the first upward motion, or of all. [N]
  std::optional<double> peak_pull_force;  ///< Largest |force along the approach axis| from the
                                          ///< first upward motion on. [N]
  std::optional<double> peak_pull_at;     ///< When. [s]
  int seal_flips{0};                      ///< Changes between a grip that holds and none.
  int steps{0};                           ///< Undone ones included.
  int undone_steps{0};                    ///< Steps that did not end as kOk.
  double max_penetration{0.0};            ///< [m]
  double max_friction{0.0};               ///< Largest friction force on the cup. [N]
  double mean_contacts{0.0};              ///< A step: contacts of the cup that carry load,
  double mean_candidates{0.0};            ///< contact constraints in the problem,
  double mean_iterations{0.0};            ///< iterations of the last contact solve.
  double min_gauge_pressure{0.0};         ///< Deepest vacuum in the cavity. [Pa]
  int elements{0};                        ///< Tetrahedra of the cup.
  int nodes{0};                           ///< Nodes of the cup.
  double seal_close_gap{0.0};             ///< As given or derived from the mesh. [m]
  double seal_open_gap{0.0};              ///< As given or derived from the mesh. [m]
  double simulated_time{0.0};             ///< [s]
  double median_step_ms{0.0};             ///< Wall time of a step. [ms]
  double p99_step_ms{0.0};                ///< Nearest rank. [ms]
  double real_time_factor{0.0};           ///< Simulated time / wall time of the steps.
  std::vector<FreeObjectSummary> free_objects;
};

/** Collects the figures of an experiment from its steps.

 The approach axis is z of `cup_frame`; upward motion is motion of the mount against it. The mount's
 first way down to the surface therefore does not count, a sideways move neither. */
class SummaryAccumulator {
 public:
  /// @param X_WM Pose of the mount before the first step. @param objects The world then.
  /// @param time_step h. [s]
  SummaryAccumulator(const Eigen::Isometry3d& X_WM, const std::vector<RigidObject>& objects,
                     double time_step);

  void Add(const StepResult& result);
  ExperimentSummary Summary() const;

 private:
  void AddSeal(const StepResult& result);
  void AddForce(const StepResult& result);
  void AddObjects(const StepResult& result);

  ExperimentSummary summary_;
  double time_step_;
  Eigen::Isometry3d X_WM_;  // after the previous step
  bool holds_{false};
  SealStatus status_{SealStatus::kOpen};
  bool pulled_{false};
  std::vector<double> step_ms_;
};

/// Writes the summary as YAML; a figure that is empty is `null`.
void WriteSummary(const ExperimentSummary& summary, const std::string& scenario,
                  std::ostream* stream);

}  // namespace vacuum_gripper_sim
