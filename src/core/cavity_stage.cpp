#include "vacuum_gripper_sim/core/cavity_stage.h"

#include <algorithm>
#include <cmath>

#include "vacuum_gripper_sim/core/stopwatch.h"

namespace vacuum_gripper_sim {

CavityStage::CavityStage(const CavitySurface& cavity, double open_gap, double young_modulus)
    : cavity_(&cavity),
      edge_ways_(cavity),
      classifier_(cavity),
      open_gap_(open_gap),
      young_modulus_(young_modulus) {}

void CavityStage::Begin(const Eigen::Matrix3Xd& x_W) {
  num_nodes_ = x_W.cols();
  PointAreaVectors(*cavity_, x_W, &area_vectors_);
}

bool CavityStage::Solve(const std::vector<double>& pressures, const std::vector<bool>& wet,
                        ContactStage::Accuracy accuracy, ContactStage* stage,
                        SuctionSolution* solution, StepTimings* timings) {
  solution->load.setZero(3, num_nodes_);
  was_wet_.assign(cavity_->nodes.size(), false);
  for (std::size_t cup = 0; cup < pressures.size(); ++cup) {
    if (pressures[cup] == 0.0) continue;
    for (int point = cavity_->first_points[cup]; point < cavity_->first_points[cup + 1]; ++point) {
      const auto i = static_cast<std::size_t>(point);
      if (!wet[i]) continue;
      was_wet_[i] = true;
      solution->load.col(cavity_->nodes[i]) += pressures[cup] * area_vectors_.col(point);
    }
  }
  if (!stage->Solve(solution->load, accuracy, &solution->contact, timings)) return false;
  const Stopwatch stopwatch(&timings->classification);
  ClassifyEnd(*stage, solution->contact, &solution->classification);
  return true;
}

void CavityStage::ClassifyEnd(const ContactStage& stage, const ContactSolution& contact,
                              Classification* classification) {
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
      edge_ways_.Find(phi_, open_gap_, contact.x_W,
                      [&](const Eigen::Vector3d& p_W) { return stage.Distance(p_W); });
  classifier_.Classify(phi_, open_gap_, was_wet_, classification);
}

}  // namespace vacuum_gripper_sim
