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

struct SteadyCase {
  std::string name;
  std::string bell;
  SimulatorParameters parameters;
  std::vector<RigidObject> objects;  // their upper face at z = 0
};

std::string NameOf(const testing::TestParamInfo<SteadyCase>& info) { return info.param.name; }

/// A grip that was pressed on and holds.
class HeldGrip : public testing::TestWithParam<SteadyCase> {
 protected:
  void SetUp() override {
    constexpr double kPressed = kCupLength - 1e-3;  // m
    cycle_.simulator().SetObjects(GetParam().objects);
    cycle_.Drive(kPressed, 0.01, 0.0, 0.2);
    cycle_.Drive(kPressed, 0.01, kSuction, 0.5);
    ASSERT_EQ(cycle_.result().status, SealStatus::kSealed);
  }

  /// The most allocations that one of 30 steps makes. @param way Of the mount in each, up. [m]
  long MostAllocations(double way) {
    long most = 0;
    for (int i = 0; i < 30; ++i) {
      const double height = cycle_.height() + way;
      const long before = CountAllocations();
      way == 0.0 ? cycle_.Step(kSuction) : cycle_.Drive(height, 1.0, kSuction);
      most = std::max(most, CountAllocations() - before);
    }
    EXPECT_TRUE(Holds(cycle_.result()));
    EXPECT_EQ(cycle_.undone_steps, 0);
    RecordProperty("most_allocations", std::to_string(most));
    return most;
  }

  GripCycle cycle_{LoadBell(GetParam().bell), GetParam().parameters};
};

class SteadyState : public HeldGrip {};
class PulledGrip : public HeldGrip {};

TEST_P(SteadyState, StepsAllocateNothing) { EXPECT_EQ(MostAllocations(0.0), 0); }

// When contacts become more or fewer, eight vectors and matrices as long as their rows change their
// size; a pass or two of a step may bring that.
TEST_P(PulledGrip, StepsAllocateAFewTimesAtMost) { EXPECT_LE(MostAllocations(1e-5), 30); }

TEST(CountAllocations, SeesNewAndEigen) {
  const long before = CountAllocations();
  const auto number = std::make_unique<std::vector<int>>(100);
  const Eigen::VectorXd vector = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(number->size()));
  EXPECT_EQ(vector.sum(), 100.0);
  EXPECT_EQ(CountAllocations() - before, 3);
}

SteadyCase Case(const std::string& bell, const std::string& name) {
  return {bell + "_" + name, bell, A20(kTimeStep), {FixedObject(RigidSurface{"plate", Plane{}})}};
}

SteadyCase Direct(const std::string& bell) { return Case(bell, "direct"); }

SteadyCase DoublePrecision(const std::string& bell) {
  SteadyCase result = Case(bell, "double_precision");
  result.parameters.linear_solver.precision = Precision::kDouble;
  return result;
}

SteadyCase ConjugateGradient(const std::string& bell) {
  SteadyCase result = Case(bell, "conjugate_gradient");
  result.parameters.linear_solver.method = LinearSolverMethod::kConjugateGradient;
  return result;
}

SteadyCase Shared(const std::string& bell) {
  SteadyCase result = Case(bell, "shared");
  result.parameters.linear_solver.threads = 2;
  return result;
}

SteadyCase SharedIterations(const std::string& bell) {
  SteadyCase result = ConjugateGradient(bell);
  result.parameters.linear_solver.threads = 2;
  result.name += "_shared";
  return result;
}

SteadyCase Ejector(const std::string& bell) {
  SteadyCase result = Case(bell, "ejector");
  result.parameters.vacuum.source = VacuumSourceType::kEjector;
  return result;
}

SteadyCase Friction(const std::string& bell) {
  SteadyCase result = Case(bell, "friction");
  result.objects[0].surfaces[0].friction = 0.5;
  return result;
}

/// A box that lies on the plate.
SteadyCase FreeBox(const std::string& bell) {
  constexpr double kHeight = 0.02;  // m
  SteadyCase result = Friction(bell);
  result.name = bell + "_free_box";
  result.parameters.gravity = {0.0, 0.0, -9.81};
  result.objects[0].X_WO.translation().z() = -kHeight;
  RigidObject box = FixedObject(RigidSurface{"box", Box{{0.1, 0.1, kHeight}}});
  box.X_WO.translation().z() = -0.5 * kHeight;
  box.surfaces[0].friction = 0.5;
  box.inertia = RigidInertia();
  box.inertia->mass = 0.02;
  box.inertia->about_C_O = 2e-5 * Eigen::Matrix3d::Identity();
  result.objects.push_back(box);
  return result;
}

// Not the asynchronous solver: when its thread allocates for the first time is up to the scheduler.
const char kLinear[] = "linear_700";
const char kQuadratic[] = "quadratic_700";

INSTANTIATE_TEST_SUITE_P(Cups, SteadyState,
                         testing::Values(Direct(kLinear), DoublePrecision(kLinear),
                                         ConjugateGradient(kLinear), Ejector(kLinear),
                                         Friction(kLinear), FreeBox(kLinear), Direct(kQuadratic),
                                         DoublePrecision(kQuadratic), ConjugateGradient(kQuadratic),
                                         Shared(kQuadratic), Ejector(kQuadratic)),
                         NameOf);
INSTANTIATE_TEST_SUITE_P(Cups, PulledGrip,
                         testing::Values(Direct(kLinear), ConjugateGradient(kLinear),
                                         Direct(kQuadratic), ConjugateGradient(kQuadratic),
                                         SharedIterations(kQuadratic)),
                         NameOf);

}  // namespace
}  // namespace vacuum_gripper_sim
