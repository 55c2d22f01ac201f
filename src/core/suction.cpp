#include "vacuum_gripper_sim/core/suction.h"

#include <algorithm>
#include <cmath>

#include "vacuum_gripper_sim/core/stopwatch.h"

namespace vacuum_gripper_sim {

Suction::Suction(const CavitySurface& cavity, const SealParameters& seal,
                 const RegulatorParameters& regulator, double young_modulus)
    : cavity_(&cavity),
      edge_ways_(cavity),
      classifier_(cavity),
      seal_(seal),
      regulator_(regulator),
      young_modulus_(young_modulus) {}

void Suction::ClassifyEnd(const ContactStage& stage, const ContactSolution& contact,
                          const std::vector<bool>& was_wet, Classification* classification) {
  // Loaded points are ordered by the depth by which an elastic half space under a patch of the
  // point's size would be indented, p sqrt(a) / E: a length, as a gap is. Only its order decides.
  phi_.resize(cavity_->nodes.size());
  for (std::size_t i = 0; i < phi_.size(); ++i) {
    const int node = cavity_->nodes[i];
    const double force = contact.lambda(node);
    if (force > 0.0) {
      const double area =
          std::max(area_vectors_.col(static_cast<Eigen::Index>(i)).norm(), 1e-12);  // [m^2]
      phi_[i] = -force / (young_modulus_ * std::sqrt(area));
    } else {
      phi_[i] = contact.distance[static_cast<std::size_t>(node)];
    }
  }
  classification->edge_ways =
      edge_ways_.Find(phi_, *seal_.open_gap, contact.x_W,
                      [&](const Eigen::Vector3d& p_W) { return stage.Distance(p_W); });
  classifier_.Classify(phi_, *seal_.open_gap, was_wet, classification);
}

bool Suction::SolveWith(const std::vector<bool>& wet, double pressure, ContactStage* stage,
                        SuctionSolution* solution, StepTimings* timings) {
  solution->load.setZero(3, num_nodes_);
  if (pressure != 0.0) {
    for (std::size_t i = 0; i < wet.size(); ++i) {
      if (!wet[i]) continue;
      solution->load.col(cavity_->nodes[i]) +=
          pressure * area_vectors_.col(static_cast<Eigen::Index>(i));
    }
  }
  if (!stage->Solve(solution->load, &solution->contact, timings)) return false;
  const Stopwatch stopwatch(&timings->classification);
  const std::vector<bool> never;
  ClassifyEnd(*stage, solution->contact, pressure != 0.0 ? wet : never, &solution->classification);
  return true;
}

bool Suction::HoldSeal(double pressure, ContactStage* stage, GripState* state,
                       SuctionSolution* solution, StepTimings* timings) {
  std::vector<std::vector<bool>> seen;
  wet_ = state->classification.wet;
  for (int round = 1;; ++round) {
    if (!SolveWith(wet_, pressure, stage, solution, timings)) return false;
    if (round == seal_.max_rounds) break;
    seen.push_back(wet_);
    wet_ = solution->classification.wet;
    if (std::find(seen.begin(), seen.end(), wet_) != seen.end()) break;  // fixed point or cycle
  }
  if (solution->classification.bottleneck_gap <= *seal_.open_gap) {
    state->pressure = pressure;
    return true;
  }
  state->sealed = false;
  state->lost = true;
  state->pressure = 0.0;
  return SolveWith({}, 0.0, stage, solution, timings);
}

bool Suction::TryToSeal(double pressure, ContactStage* stage, GripState* state,
                        SuctionSolution* solution, StepTimings* timings) {
  if (!SolveWith({}, 0.0, stage, solution, timings)) return false;  // (1)
  if (solution->classification.bottleneck_gap >= *seal_.close_gap) return true;

  wet_ = solution->classification.wet;
  for (int i = 1; i <= seal_.ramp_increments; ++i) {  // (2)
    if (!SolveWith(wet_, pressure * i / seal_.ramp_increments, stage, solution, timings)) {
      return false;
    }
    wet_ = solution->classification.wet;
    if (solution->classification.bottleneck_gap > *seal_.open_gap) {
      return SolveWith({}, 0.0, stage, solution, timings);  // suction opens it: no seal yet
    }
  }
  if (!SolveWith(wet_, pressure, stage, solution, timings)) return false;  // (3)
  if (solution->classification.bottleneck_gap > *seal_.open_gap) {
    return SolveWith({}, 0.0, stage, solution, timings);
  }
  state->sealed = true;
  state->lost = false;
  state->pressure = pressure;
  return true;
}

bool Suction::Solve(const Eigen::Matrix3Xd& x_W, double setpoint, double h, ContactStage* stage,
                    GripState* state, SuctionSolution* solution, StepTimings* timings) {
  num_nodes_ = x_W.cols();
  PointAreaVectors(*cavity_, x_W, &area_vectors_);

  const double largest_change = regulator_.ramp_rate * h;
  const double change = std::clamp(setpoint - state->pressure, -largest_change, largest_change);
  // Not pressure + change where the set-point is in reach: it is to be met exactly.
  const double pressure =
      std::abs(setpoint - state->pressure) <= largest_change ? setpoint : state->pressure + change;

  bool solved = false;
  if (state->sealed && pressure != 0.0) {
    solved = HoldSeal(pressure, stage, state, solution, timings);
  } else if (pressure != 0.0) {
    solved = TryToSeal(pressure, stage, state, solution, timings);
  } else {
    state->sealed = false;
    state->pressure = 0.0;
    solved = SolveWith({}, 0.0, stage, solution, timings);
  }
  if (setpoint == 0.0) state->lost = false;  // venting may open the lip: that is no loss
  state->classification = solution->classification;
  return solved;
}

}  // namespace vacuum_gripper_sim
