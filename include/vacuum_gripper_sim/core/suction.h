#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_stage.h"
#include "vacuum_gripper_sim/core/contact_stage.h"
#include "vacuum_gripper_sim/core/grip_state.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/step_result.h"

namespace vacuum_gripper_sim {

/** Couples the cavities' pressures with the contacts: the mixed complementarity problem of
 [Bernardin, Sec. III-C],

     delta = delta_free + W_cc lambda_c + W_cp lambda_p,
     0 <= delta  perp  lambda_c >= 0,   lambda_p = p,

 where p, and the points it acts on, depend on whether the cavity is airtight.

 Without an earlier seal, the paper's three stages: (1) contacts without pressure; if the cavity is
 then airtight, (2) raise lambda_p in increments, reclassifying after each; (3) solve the contacts
 with the final classification, unless the last increment already had it. Increments before the last
 are solved less exactly, but none of them opens a cavity without a second look. With an earlier
 seal, the step starts from the previous pressure and classification instead - without its pressure
 the lip would spring off within one implicit step and a tight cup would read as leaking - and is
 solved and reclassified until the wet points repeat or `max_rounds` is reached. The seal is lost
 only if the state at the *end* leaks; then the step is solved again without pressure.

 The regulator moves lambda_p towards the set-point by at most ramp_rate * h a step. Several cups
 take these ways side by side, each with a seal of its own. */
class Suction {
 public:
  /// @param cavity Must outlive this. @param seal With its gaps set.
  /// @param young_modulus Scales the order of loaded points. [Pa]
  Suction(const CavitySurface& cavity, const SealParameters& seal,
          const RegulatorParameters& regulator, double young_modulus);

  /** Solves the step's contacts and pressure.
   @param x_W Positions at the step's start: H_p is that of [Bernardin, Sec. III-C] there.
   @param setpoint Gauge pressure wanted. [Pa] @param h Time step. [s]
   @param stage Begun with the step's free motion.
   @param[in,out] state @param[out] solution @param[in,out] timings
   @returns false if A is not positive definite. */
  bool Solve(const Eigen::Matrix3Xd& x_W, double setpoint, double h, ContactStage* stage,
             GripState* state, SuctionSolution* solution, StepTimings* timings);

 private:
  using Accuracy = ContactStage::Accuracy;

  /// Solves with the pressures and the wet points of the moment.
  bool SolveOnce(Accuracy accuracy, ContactStage* stage, SuctionSolution* solution,
                 StepTimings* timings);
  bool HoldSeals(ContactStage* stage, GripState* state, SuctionSolution* solution,
                 StepTimings* timings);
  bool TryToSeal(ContactStage* stage, GripState* state, SuctionSolution* solution,
                 StepTimings* timings);
  bool IsOpen(const Classification& classification, int cup) const;
  /// Gives up those of the cups whose cavity has come open. @returns if there were some.
  bool ReleaseOpen(const Classification& classification, std::vector<int>* cups);
  /// Lets the pressure act on what a classification found wet of some cups.
  void SetWet(const std::vector<int>& cups, const Classification& classification);

  CavityStage cavity_;
  SealParameters seal_;
  RegulatorParameters regulator_;
  // That the next solve loads: pressures of the cups [Pa], and which points of theirs.
  std::vector<double> pressures_;
  std::vector<bool> wet_;
  // Of the step at hand.
  std::vector<double> of_new_seals_;     // pressures that cups with a new seal are to have [Pa]
  std::vector<int> holding_, trying_;    // cups
  std::vector<std::vector<bool>> seen_;  // wet points by round
  std::vector<bool> loaded_;             // wet points of the last increment
};

}  // namespace vacuum_gripper_sim
