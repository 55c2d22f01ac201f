#pragma once

#include <string>

#include "physics/grip_cycle.h"

namespace vacuum_gripper_sim {

/// What a cup is doing while its steps are timed.
enum class Situation {
  kAir,      ///< Above the plate, at rest.
  kPressed,  ///< Pressed onto it by 1 mm, without suction.
  kSealed,   ///< And held there at -6 kPa.
  kPulled,   ///< Under suction, lifted by 0 to 3 mm up and down at 5 mm/s: contacts come and go.
  kLeaking,  ///< Lowered onto a plate tilted by 8 degrees, suction on: one side stands open.
  kCycle,    ///< Pressed, sealed, pulled off until it lets go, vented, over and over.
};

inline constexpr struct {
  Situation situation;
  const char* name;
} kSituations[] = {{Situation::kAir, "air"},         {Situation::kPressed, "pressed"},
                   {Situation::kSealed, "sealed"},   {Situation::kPulled, "pulled"},
                   {Situation::kLeaking, "leaking"}, {Situation::kCycle, "cycle"}};

/// A cup of A20 brought into a situation and kept there.
class GripSituation {
 public:
  /// @param bell Name of one of meshes/bell_*.msh. @param time_step [s]
  GripSituation(const std::string& bell, Situation situation, LinearSolverMethod method,
                int threads = 1, double time_step = 0.01);

  /// The situation's next step.
  void Step();

  GripCycle& cycle() { return cycle_; }
  const StepResult& result() const { return cycle_.result(); }

 private:
  void StepUpAndDown(double lowest, double highest);
  void StepThroughCycle();

  Situation situation_;
  double h_;
  GripCycle cycle_;
  double direction_{1.0};  // of the mount, up or down
  double held_{0.0};       // for how long a cycle has pressed [s]
};

}  // namespace vacuum_gripper_sim
