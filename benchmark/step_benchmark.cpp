// Whole steps of the default cups in the states of a grip, with the time of every phase beside the
// paper's. Thread-CPU time is the benchmark's; the phases are wall time.
#include <benchmark/benchmark.h>

#include <string>
#include <utility>

#include "physics/grip_cycle.h"

namespace vacuum_gripper_sim {
namespace {

enum class Phase { kAir, kPressed, kSealed, kPulled };

void Prepare(Phase phase, GripCycle* cycle) {
  if (phase == Phase::kAir) return cycle->Drive(kCupLength + 0.005, 0.05, 0.0, 0.1);
  cycle->Drive(kCupLength - 0.001, 0.01, 0.0, 0.1);
  if (phase == Phase::kPressed) return;
  cycle->Drive(kCupLength - 0.001, 0.01, -6000.0, 0.2);
  if (phase == Phase::kPulled) cycle->Drive(kCupLength + 0.002, 0.01, -6000.0);
}

void Step(benchmark::State& state, const char* bell, Phase phase) {
  GripCycle cycle(LoadBell(bell), A20(0.01));
  Prepare(phase, &cycle);
  const double setpoint = phase == Phase::kSealed || phase == Phase::kPulled ? -6000.0 : 0.0;
  StepTimings sum;
  for (auto _ : state) {
    cycle.Step(setpoint);
    const StepTimings& timings = cycle.result().timings;
    sum.assembly += timings.assembly;
    sum.factorization += timings.factorization;
    sum.free_motion += timings.free_motion;
    sum.narrow_phase += timings.narrow_phase;
    sum.classification += timings.classification;
    sum.delassus += timings.delassus;
    sum.solve += timings.solve;
    sum.correction += timings.correction;
  }
  const auto per_step = [&](double seconds) {
    return benchmark::Counter(1e3 * seconds, benchmark::Counter::kAvgIterations);
  };
  state.counters["assembly_ms"] = per_step(sum.assembly);
  state.counters["factor_ms"] = per_step(sum.factorization);
  state.counters["free_ms"] = per_step(sum.free_motion);
  state.counters["narrow_ms"] = per_step(sum.narrow_phase);
  state.counters["classify_ms"] = per_step(sum.classification);
  state.counters["W_ms"] = per_step(sum.delassus);
  state.counters["solve_ms"] = per_step(sum.solve);
  state.counters["correct_ms"] = per_step(sum.correction);
  state.counters["candidates"] = cycle.result().num_candidates;
}

/// Eigen's product of two dense 512 x 512 matrices: how fast this machine is just now.
void Yardstick(benchmark::State& state) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(512, 512);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(512, 512);
  Eigen::MatrixXd c(512, 512);
  for (auto _ : state) {
    c.noalias() = a * b;
    benchmark::DoNotOptimize(c.data());
  }
}

void RegisterAll() {
  benchmark::RegisterBenchmark("Yardstick", Yardstick)->Unit(benchmark::kMillisecond);
  for (const char* const bell :
       {"linear_700", "linear_3000", "linear_10000", "quadratic_700", "quadratic_3000"}) {
    for (const auto& [name, phase] :
         {std::pair{"air", Phase::kAir}, std::pair{"pressed", Phase::kPressed},
          std::pair{"sealed", Phase::kSealed}, std::pair{"pulled", Phase::kPulled}}) {
      const std::string title = std::string(bell) + "/" + name;
      benchmark::RegisterBenchmark(title.c_str(), Step, bell, phase)->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim

int main(int argc, char** argv) {
  vacuum_gripper_sim::RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
