#include "vacuum_gripper_sim/core/suction.h"

#include <algorithm>
#include <cmath>

namespace vacuum_gripper_sim {

Suction::Suction(const CavitySurface& cavity, const SealParameters& seal,
                 const RegulatorParameters& regulator, double young_modulus)
    : cavity_(cavity, *seal.open_gap, young_modulus), seal_(seal), regulator_(regulator) {}

bool Suction::SolveOnce(Accuracy accuracy, ContactStage* stage, SuctionSolution* solution,
                        StepTimings* timings) {
  return cavity_.Solve(pressures_, wet_, accuracy, stage, solution, timings);
}

void Suction::SetWet(const std::vector<int>& cups, const Classification& classification) {
  for (const int cup : cups) {
    const std::vector<int>& first_points = cavity_.cavity().first_points;
    const int begin = first_points[static_cast<std::size_t>(cup)];
    const int end = first_points[static_cast<std::size_t>(cup) + 1];
    std::copy(classification.wet.begin() + begin, classification.wet.begin() + end,
              wet_.begin() + begin);
  }
}

bool Suction::IsOpen(const Classification& classification, int cup) const {
  return classification.bottleneck_gaps[static_cast<std::size_t>(cup)] > *seal_.open_gap;
}

bool Suction::ReleaseOpen(const Classification& classification, std::vector<int>* cups) {
  const auto is_open = [&](int cup) { return IsOpen(classification, cup); };
  for (const int cup : *cups) {
    if (is_open(cup)) pressures_[static_cast<std::size_t>(cup)] = 0.0;
  }
  const auto rest = std::remove_if(cups->begin(), cups->end(), is_open);
  const bool some_are = rest != cups->end();
  cups->erase(rest, cups->end());
  return some_are;
}

/// Solves with the pressures of the cups that have a seal; without any, that is the stage (1).
bool Suction::HoldSeals(ContactStage* stage, GripState* state, SuctionSolution* solution,
                        StepTimings* timings) {
  holding_.clear();
  for (std::size_t cup = 0; cup < pressures_.size(); ++cup) {
    if (pressures_[cup] != 0.0) holding_.push_back(static_cast<int>(cup));
  }
  do {
    SetWet(holding_, state->classification);
    for (int round = 1;; ++round) {
      if (!SolveOnce(Accuracy::kFull, stage, solution, timings)) return false;
      if (round == seal_.max_rounds || holding_.empty()) break;
      const auto num_seen = static_cast<std::size_t>(round);
      if (seen_.size() < num_seen) seen_.emplace_back();
      seen_[num_seen - 1] = wet_;
      SetWet(holding_, solution->classification);
      const auto end = seen_.begin() + round;
      if (std::find(seen_.begin(), end, wet_) != end) break;  // fixed point or cycle
    }
  } while (ReleaseOpen(solution->classification, &holding_));
  for (std::size_t cup = 0; cup < pressures_.size(); ++cup) {
    CavityState& cavity = state->cups[cup];
    if (cavity.sealed && pressures_[cup] == 0.0) {
      cavity.sealed = false;
      cavity.lost = true;
    }
    cavity.pressure = pressures_[cup];
  }
  return true;
}

bool Suction::TryToSeal(ContactStage* stage, GripState* state, SuctionSolution* solution,
                        StepTimings* timings) {
  trying_.clear();
  for (std::size_t cup = 0; cup < of_new_seals_.size(); ++cup) {
    if (of_new_seals_[cup] == 0.0) continue;
    if (solution->classification.bottleneck_gaps[cup] >= *seal_.close_gap) continue;
    trying_.push_back(static_cast<int>(cup));
  }
  SetWet(trying_, solution->classification);
  bool settled = false;  // Has the last increment been solved, with the final classification?
  for (int i = 1; i <= seal_.ramp_increments && !trying_.empty(); ++i) {  // (2)
    const bool is_last = i == seal_.ramp_increments;
    for (const int cup : trying_) {
      const auto k = static_cast<std::size_t>(cup);
      pressures_[k] = is_last ? of_new_seals_[k] : of_new_seals_[k] * i / seal_.ramp_increments;
    }
    loaded_ = wet_;
    if (!is_last && !SolveOnce(Accuracy::kTrial, stage, solution, timings)) return false;
    const bool look_closely = is_last || std::any_of(trying_.begin(), trying_.end(), [&](int cup) {
                                return IsOpen(solution->classification, cup);
                              });
    if (look_closely && !SolveOnce(Accuracy::kFull, stage, solution, timings)) return false;
    SetWet(trying_, solution->classification);
    const bool some_opened = ReleaseOpen(solution->classification, &trying_);
    if (some_opened && trying_.empty()) {  // suction opens them: no seal yet
      return SolveOnce(Accuracy::kFull, stage, solution, timings);
    }
    settled = !some_opened && wet_ == loaded_ && solution->contact.settled;
  }
  if (trying_.empty()) return true;
  if (!settled) {
    do {  // (3)
      if (!SolveOnce(Accuracy::kFull, stage, solution, timings)) return false;
    } while (ReleaseOpen(solution->classification, &trying_));
  }
  for (const int cup : trying_) {
    const auto k = static_cast<std::size_t>(cup);
    state->cups[k].sealed = true;
    state->cups[k].lost = false;
    state->cups[k].pressure = pressures_[k];
  }
  return true;
}

bool Suction::Solve(const Eigen::Matrix3Xd& x_W, double setpoint, double h, ContactStage* stage,
                    GripState* state, SuctionSolution* solution, StepTimings* timings) {
  cavity_.Begin(x_W);
  wet_.resize(cavity_.cavity().nodes.size());

  const double largest_change = regulator_.ramp_rate * h;
  pressures_.assign(state->cups.size(), 0.0);
  of_new_seals_.assign(state->cups.size(), 0.0);
  for (std::size_t cup = 0; cup < state->cups.size(); ++cup) {
    CavityState& cavity = state->cups[cup];
    const double change = std::clamp(setpoint - cavity.pressure, -largest_change, largest_change);
    // Not pressure + change where the set-point is in reach: it is to be met exactly.
    const double pressure = std::abs(setpoint - cavity.pressure) <= largest_change
                                ? setpoint
                                : cavity.pressure + change;
    if (pressure == 0.0) cavity.sealed = false;
    (cavity.sealed ? pressures_ : of_new_seals_)[cup] = pressure;
  }
  const bool solved =
      HoldSeals(stage, state, solution, timings) && TryToSeal(stage, state, solution, timings);
  for (CavityState& cavity : state->cups) {
    if (setpoint == 0.0) cavity.lost = false;  // venting may open the lip: that is no loss
  }
  state->classification = solution->classification;
  return solved;
}

}  // namespace vacuum_gripper_sim
