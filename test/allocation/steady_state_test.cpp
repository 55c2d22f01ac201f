#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "counter.h"
#include "physics/grip_cycle.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kTimeStep = 0.01;    // s
constexpr double kSuction = -6000.0;  // Pa

/// Allocations of a step, whatever the size of the cup. 38 to 40 are left where a step factorises;
/// the margin is for other versions of Eigen.
constexpr long kMost = 42;

struct SteadyCase {
  std::string bell;
  LinearSolverMethod method;
};

std::string NameOf(const testing::TestParamInfo<SteadyCase>& info) {
  const bool direct = info.param.method == LinearSolverMethod::kDirect;
  return info.param.bell + (direct ? "_direct" : "_conjugate_gradient");
}

class SteadyState : public testing::TestWithParam<SteadyCase> {
 protected:
  /// The most allocations that one of `count` steps under a set-point makes.
  static long MostAllocations(GripCycle* cycle, double setpoint, int count) {
    long most = 0;
    for (int i = 0; i < count; ++i) {
      const long before = CountAllocations();
      cycle->Step(setpoint);
      most = std::max(most, CountAllocations() - before);
    }
    return most;
  }
};

TEST_P(SteadyState, StepsOfAHeldGripAllocateAFewTimesAtMost) {
  SimulatorParameters parameters = A20(kTimeStep);
  parameters.linear_solver.method = GetParam().method;
  GripCycle cycle(LoadBell(GetParam().bell), parameters);
  constexpr double kPressed = kCupLength - 1e-3;  // m
  cycle.Drive(kPressed, 0.01, 0.0, 0.2);
  cycle.Drive(kPressed, 0.01, kSuction, 0.5);
  ASSERT_EQ(cycle.result().status, SealStatus::kSealed);

  const long most = MostAllocations(&cycle, kSuction, 30);
  EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
  EXPECT_LE(most, kMost);
  RecordProperty("most_allocations", std::to_string(most));
}

TEST(CountAllocations, SeesNewAndEigen) {
  const long before = CountAllocations();
  const auto number = std::make_unique<std::vector<int>>(100);
  const Eigen::VectorXd vector = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(number->size()));
  EXPECT_EQ(vector.sum(), 100.0);
  EXPECT_EQ(CountAllocations() - before, 3);
}

INSTANTIATE_TEST_SUITE_P(
    Cups, SteadyState,
    testing::Values(SteadyCase{"linear_700", LinearSolverMethod::kDirect},
                    SteadyCase{"linear_700", LinearSolverMethod::kConjugateGradient},
                    SteadyCase{"quadratic_700", LinearSolverMethod::kDirect},
                    SteadyCase{"quadratic_700", LinearSolverMethod::kConjugateGradient}),
    NameOf);

}  // namespace
}  // namespace vacuum_gripper_sim
