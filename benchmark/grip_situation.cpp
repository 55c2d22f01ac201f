#include "grip_situation.h"

#include <algorithm>

namespace vacuum_gripper_sim {
namespace {

constexpr double kSuction = -6000.0;                      // Pa
constexpr double kPressedHeight = kCupLength - 1e-3;      // m
constexpr double kPressSpeed = 0.01, kPullSpeed = 0.005;  // m/s
constexpr double kWithinOneStep = 1.0;                    // m/s

SimulatorParameters With(LinearSolverMethod method, int threads, double time_step) {
  SimulatorParameters parameters = A20(time_step);
  parameters.linear_solver.method = method;
  parameters.linear_solver.threads = threads;
  return parameters;
}

}  // namespace

GripSituation::GripSituation(const std::string& bell, Situation situation,
                             LinearSolverMethod method, int threads, double time_step)
    : situation_(situation),
      h_(time_step),
      cycle_(LoadBell(bell), With(method, threads, time_step)) {
  constexpr double kSettling = 0.2;  // s
  switch (situation) {
    case Situation::kAir:
      cycle_.Drive(kCupLength + 0.005, 0.05, 0.0, kSettling);
      break;
    case Situation::kPressed:
      cycle_.Drive(kPressedHeight, kPressSpeed, 0.0, kSettling);
      break;
    case Situation::kSealed:
    case Situation::kPulled:
      cycle_.Drive(kPressedHeight, kPressSpeed, 0.0, kSettling);
      cycle_.Drive(kPressedHeight, kPressSpeed, kSuction, kSettling);
      if (situation == Situation::kPulled) cycle_.Drive(kCupLength, kPullSpeed, kSuction);
      break;
    case Situation::kLeaking: {
      Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
      X_WO.rotate(Eigen::AngleAxisd(8.0 / 180.0 * EIGEN_PI, Eigen::Vector3d::UnitX()));
      cycle_.Drive(kCupLength + 0.005, 0.05, 0.0);
      cycle_.simulator().SetObjectPose(0, X_WO);
      cycle_.Drive(kCupLength, kPressSpeed, kSuction, kSettling);
      break;
    }
    case Situation::kCycle:
      cycle_.Drive(kCupLength + 0.001, kPressSpeed, 0.0);
      direction_ = -1.0;
      break;
  }
}

void GripSituation::Step() {
  switch (situation_) {
    case Situation::kAir:
    case Situation::kPressed:
      return cycle_.Step(0.0);
    case Situation::kSealed:
    case Situation::kLeaking:
      return cycle_.Step(kSuction);
    case Situation::kPulled:
      return StepUpAndDown(kCupLength, kCupLength + 0.003);
    case Situation::kCycle:
      return StepThroughCycle();
  }
}

void GripSituation::StepUpAndDown(double lowest, double highest) {
  const double stride = kPullSpeed * h_;
  if (cycle_.height() + stride > highest) direction_ = -1.0;
  if (cycle_.height() - stride < lowest) direction_ = 1.0;
  cycle_.Drive(cycle_.height() + direction_ * stride, kWithinOneStep, kSuction);
}

void GripSituation::StepThroughCycle() {
  constexpr double kPressed = 0.1, kSealed = 0.2;  // s
  if (direction_ < 0.0) {
    const double height = std::max(cycle_.height() - kPressSpeed * h_, kPressedHeight);
    if (height != cycle_.height()) return cycle_.Drive(height, kWithinOneStep, 0.0);
    held_ += h_;
    const bool suck = held_ > kPressed + 0.5 * h_;
    if (held_ > kPressed + kSealed + 0.5 * h_) {
      direction_ = 1.0;
      held_ = 0.0;
    }
    return cycle_.Step(suck ? kSuction : 0.0);
  }
  const double height = cycle_.height() + kPullSpeed * h_;
  cycle_.Drive(height, kWithinOneStep, kSuction);
  if (!Holds(result())) direction_ = -1.0;
}

}  // namespace vacuum_gripper_sim
