#include "vacuum_gripper_sim/core/suction.h"

#include <algorithm>
#include <cmath>

namespace vacuum_gripper_sim {

Suction::Suction(const CavitySurface& cavity, const SealParameters& seal,
                 const RegulatorParameters& regulator, double young_modulus)
    : cavity_(cavity, *seal.open_gap, young_modulus), seal_(seal), regulator_(regulator) {}

bool Suction::SolveOnce(ContactStage* stage, SuctionSolution* solution, StepTimings* timings) {
  return cavity_.Solve(pressures_, wet_, stage, solution, timings);
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

bool Suction::ReleaseOpen(const Classification& classification, std::vector<int>* cups) {
  const auto is_open = [&](int cup) {
    return classification.bottleneck_gaps[static_cast<std::size_t>(cup)] > *seal_.open_gap;
  };
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
  std::vector<int> holding;
  for (std::size_t cup = 0; cup < pressures_.size(); ++cup) {
    if (pressures_[cup] != 0.0) holding.push_back(static_cast<int>(cup));
  }
  do {
    std::vector<std::vector<bool>> seen;
    SetWet(holding, state->classification);
    for (int round = 1;; ++round) {
      if (!SolveOnce(stage, solution, timings)) return false;
      if (round == seal_.max_rounds || holding.empty()) break;
      seen.push_back(wet_);
      SetWet(holding, solution->classification);
      if (std::find(seen.begin(), seen.end(), wet_) != seen.end()) break;  // fixed point or cycle
    }
  } while (ReleaseOpen(solution->classification, &holding));
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

/// @param pressure That a cup with a new seal is to have. [Pa]
bool Suction::TryToSeal(const std::vector<double>& pressure, ContactStage* stage, GripState* state,
                        SuctionSolution* solution, StepTimings* timings) {
  std::vector<int> trying;
  for (std::size_t cup = 0; cup < pressure.size(); ++cup) {
    if (pressure[cup] == 0.0) continue;
    if (solution->classification.bottleneck_gaps[cup] >= *seal_.close_gap) continue;
    trying.push_back(static_cast<int>(cup));
  }
  SetWet(trying, solution->classification);
  for (int i = 1; i <= seal_.ramp_increments && !trying.empty(); ++i) {  // (2)
    for (const int cup : trying) {
      const auto k = static_cast<std::size_t>(cup);
      pressures_[k] = pressure[k] * i / seal_.ramp_increments;
    }
    if (!SolveOnce(stage, solution, timings)) return false;
    SetWet(trying, solution->classification);
    if (ReleaseOpen(solution->classification, &trying) && trying.empty()) {
      return SolveOnce(stage, solution, timings);  // suction opens them: no seal yet
    }
  }
  if (trying.empty()) return true;
  for (const int cup : trying) {
    pressures_[static_cast<std::size_t>(cup)] = pressure[static_cast<std::size_t>(cup)];
  }
  do {  // (3)
    if (!SolveOnce(stage, solution, timings)) return false;
  } while (ReleaseOpen(solution->classification, &trying));
  for (const int cup : trying) {
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
  std::vector<double> of_new_seals(state->cups.size(), 0.0);
  for (std::size_t cup = 0; cup < state->cups.size(); ++cup) {
    CavityState& cavity = state->cups[cup];
    const double change = std::clamp(setpoint - cavity.pressure, -largest_change, largest_change);
    // Not pressure + change where the set-point is in reach: it is to be met exactly.
    const double pressure = std::abs(setpoint - cavity.pressure) <= largest_change
                                ? setpoint
                                : cavity.pressure + change;
    if (pressure == 0.0) cavity.sealed = false;
    (cavity.sealed ? pressures_ : of_new_seals)[cup] = pressure;
  }
  const bool solved = HoldSeals(stage, state, solution, timings) &&
                      TryToSeal(of_new_seals, stage, state, solution, timings);
  for (CavityState& cavity : state->cups) {
    if (setpoint == 0.0) cavity.lost = false;  // venting may open the lip: that is no loss
  }
  state->classification = solution->classification;
  return solved;
}

}  // namespace vacuum_gripper_sim
