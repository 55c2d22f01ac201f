#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/classifier.h"
#include "vacuum_gripper_sim/core/contact_stage.h"
#include "vacuum_gripper_sim/core/edge_ways.h"
#include "vacuum_gripper_sim/core/grip_state.h"

namespace vacuum_gripper_sim {

/** From the pressures of a step to its end: loads the wet points with H_p^T lambda_p, H_p that of
 the step's start [Bernardin, Sec. III-C], solves the contacts and classifies the cavities. */
class CavityStage {
 public:
  /// @param cavity Must outlive this. @param open_gap See SealParameters. [m]
  /// @param young_modulus Scales the order of loaded points. [Pa]
  CavityStage(const CavitySurface& cavity, double open_gap, double young_modulus);

  /// Starts a step. @param x_W Positions at its start, 3 by #nodes. [m]
  void Begin(const Eigen::Matrix3Xd& x_W);

  /** @param pressures Gauge, one a cup. [Pa] @param wet By point: which see their cup's pressure.
   @param accuracy Of the contacts. @param stage Begun with the step's free motion. @param[out]
   solution @param[in,out] timings
   @returns false if A is not positive definite. */
  bool Solve(const std::vector<double>& pressures, const std::vector<bool>& wet,
             ContactStage::Accuracy accuracy, ContactStage* stage, SuctionSolution* solution,
             StepTimings* timings);

  const CavitySurface& cavity() const { return *cavity_; }
  /// Of the points at the step's start. [m^2]
  const Eigen::Matrix3Xd& area_vectors() const { return area_vectors_; }

 private:
  void ClassifyEnd(const ContactStage& stage, const ContactSolution& contact,
                   Classification* classification);

  const CavitySurface* cavity_;
  EdgeWays edge_ways_;
  Classifier classifier_;
  double open_gap_;
  double young_modulus_;
  Eigen::Matrix3Xd area_vectors_;
  Eigen::Index num_nodes_{0};
  std::vector<bool> was_wet_;  // points that see suction
  std::vector<double> phi_;    // of the points, see Classifier [m]
};

}  // namespace vacuum_gripper_sim
