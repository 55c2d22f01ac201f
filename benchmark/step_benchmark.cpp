// Whole steps of the default cups in the states of a grip, with the time of every phase beside the
// paper's. Thread-CPU time is the benchmark's; the phases are wall time. `yardsticks` is the mean
// step in units of a dense matrix product timed right before and after, because machines differ.
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "physics/grip_cycle.h"

namespace vacuum_gripper_sim {
namespace {

enum class Phase { kAir, kPressed, kSealed, kPulling };

struct NamedPhase {
  const char* name;
  Phase phase;
  double setpoint;  // Pa
};
constexpr NamedPhase kPhases[] = {{"air", Phase::kAir, 0.0},
                                  {"pressed", Phase::kPressed, 0.0},
                                  {"sealed", Phase::kSealed, -6000.0},
                                  {"pulling", Phase::kPulling, -6000.0}};

struct NamedMethod {
  const char* suffix;
  LinearSolverMethod method;
};
constexpr NamedMethod kMethods[] = {{"", LinearSolverMethod::kDirect},
                                    {"/conjugate_gradient", LinearSolverMethod::kConjugateGradient},
                                    {"/asynchronous", LinearSolverMethod::kAsynchronous}};

constexpr double kPullSpeed = 0.005;  // m/s

double ThreadTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double Quantile(std::vector<double> values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Eigen's product of two dense 512 x 512 matrices: how fast this machine is just now. [s]
double Yardstick() {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(512, 512);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(512, 512);
  Eigen::MatrixXd c(512, 512);
  std::vector<double> times;
  for (int i = 0; i < 9; ++i) {
    const double begin = ThreadTime();
    c.noalias() = a * b;
    benchmark::DoNotOptimize(c.data());
    times.push_back(ThreadTime() - begin);
  }
  return Quantile(times, 0.5);
}

void Prepare(Phase phase, GripCycle* cycle) {
  if (phase == Phase::kAir) return cycle->Drive(kCupLength + 0.005, 0.05, 0.0, 0.1);
  cycle->Drive(kCupLength - 0.001, 0.01, 0.0, 0.1);
  if (phase == Phase::kPressed) return;
  cycle->Drive(kCupLength - 0.001, 0.01, -6000.0, 0.2);
  if (phase == Phase::kPulling) cycle->Drive(kCupLength, kPullSpeed, -6000.0);
}

void Step(benchmark::State& state, const char* bell, const NamedPhase& phase,
          LinearSolverMethod method) {
  SimulatorParameters parameters = A20(0.01);
  parameters.linear_solver.method = method;
  GripCycle cycle(LoadBell(bell), parameters);
  Prepare(phase.phase, &cycle);

  double yardstick = Yardstick();
  StepTimings sum;
  std::vector<double> times;
  double height = kCupLength;
  double stride = kPullSpeed * parameters.time_step;
  for (auto _ : state) {
    const double begin = ThreadTime();
    if (phase.phase == Phase::kPulling) {  // up and down again within what the seal bears
      if (height + stride > kCupLength + 0.002 || height + stride < kCupLength) stride = -stride;
      height += stride;
      cycle.Drive(height, kPullSpeed, phase.setpoint);
    } else {
      cycle.Step(phase.setpoint);
    }
    times.push_back(ThreadTime() - begin);
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
  yardstick = 0.5 * (yardstick + Yardstick());

  const auto per_step = [](double seconds) {
    return benchmark::Counter(1e3 * seconds, benchmark::Counter::kAvgIterations);
  };
  const double total = std::accumulate(times.begin(), times.end(), 0.0);
  state.counters["yardsticks"] = total / static_cast<double>(times.size()) / yardstick;
  state.counters["p99_ms"] = 1e3 * Quantile(times, 0.99);
  state.counters["max_ms"] = 1e3 * Quantile(times, 1.0);
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

void RegisterAll() {
  for (const char* const bell :
       {"linear_700", "linear_3000", "linear_10000", "quadratic_700", "quadratic_3000"}) {
    for (const NamedPhase& phase : kPhases) {
      for (const NamedMethod& method : kMethods) {
        const std::string title = std::string(bell) + "/" + phase.name + method.suffix;
        benchmark::RegisterBenchmark(title.c_str(), Step, bell, phase, method.method)
            ->Unit(benchmark::kMillisecond);
      }
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
