// Whole steps of the bells in the situations of a grip, by every linear solver, and the same steps
// by the paper's own pipeline. scripts/benchmark makes tables of it; names of the cases are
// mesh/situation/method, all times are in milliseconds. air_beside_sealed is two situations by
// turns, loop_100hz every step of a cycle at its best.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "grip_situation.h"
#include "paper_pipeline.h"
#include "repeated_cycle.h"
#include "step_statistics.h"
#include "step_time.h"
#include "thread_clock.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/stopwatch.h"

namespace vacuum_gripper_sim {
namespace {

struct Bell {
  const char* name;
  int num_steps;        // timed, in a situation that lasts
  int num_paper_steps;  // they take up to seconds
};
constexpr Bell kBells[] = {{"linear_700", 1000, 20},
                           {"linear_3000", 300, 5},
                           {"linear_10000", 100, 2},
                           {"quadratic_700", 300, 10},
                           {"quadratic_3000", 50, 1}};

constexpr int kStepsOfCycle = 200;  // about: from one press to the next

struct Loop {
  const char* bell;
  int rate;  // [Hz]
};
constexpr Loop kLoops[] = {{"linear_700", 1000},
                           {"linear_700", 100},
                           {"linear_3000", 100},
                           {"linear_10000", 100},
                           {"quadratic_700", 100}};

struct Solver {
  LinearSolverMethod method;
  int threads;
  const char* name;
};
constexpr Solver kSolvers[] = {
    {LinearSolverMethod::kDirect, 1, "direct"},
    {LinearSolverMethod::kDirect, 2, "direct_two_threads"},
    {LinearSolverMethod::kConjugateGradient, 1, "conjugate_gradient"},
    {LinearSolverMethod::kConjugateGradient, 2, "conjugate_gradient_two_threads"},
    {LinearSolverMethod::kAsynchronous, 1, "asynchronous"}};

/// Sums of the phases of StepTimings.
class Phases {
 public:
  void Add(const StepTimings& step) {
    sum_.assembly += step.assembly;
    sum_.factorization += step.factorization;
    sum_.free_motion += step.free_motion;
    sum_.narrow_phase += step.narrow_phase;
    sum_.classification += step.classification;
    sum_.delassus += step.delassus;
    sum_.solve += step.solve;
    sum_.correction += step.correction;
    sum_.total += step.total;
  }
  /// Thread-CPU time of each. The simulator's stopwatches show wall time; on a busy machine they
  /// stand still in any phase alike, so that the shares remain. @param cpu Of all steps. [s]
  std::vector<std::pair<std::string, double>> Scaled(double cpu) const {
    const double scale = cpu / sum_.total;
    return {{"assembly", scale * sum_.assembly},
            {"factorization", scale * sum_.factorization},
            {"free_motion", scale * sum_.free_motion},
            {"classification", scale * (sum_.narrow_phase + sum_.classification)},
            {"delassus", scale * sum_.delassus},
            {"solve", scale * sum_.solve},
            {"correction", scale * sum_.correction}};
  }

 private:
  StepTimings sum_;
};

void TimeSteps(benchmark::State& state, const char* bell, Situation situation,
               const Solver& solver) {
  GripSituation grip(bell, situation, solver.method, solver.threads);
  const OnOneCore on_one_core;
  StepStatistics statistics;
  Phases phases;
  double candidates = 0.0;
  double factorizations = 0.0;
  double iterations = 0.0;
  for (auto _ : state) {
    const auto [cpu, wall] = TimeStep(&grip);
    statistics.Add(cpu, wall);
    const StepResult& result = grip.result();
    phases.Add(result.timings);
    candidates += result.num_candidates;
    factorizations += result.factorizations;
    iterations += result.linear_iterations;
  }
  statistics.Report(phases.Scaled(statistics.total_cpu()), &state);
  using benchmark::Counter;
  state.counters["elements"] = grip.cycle().simulator().mesh().num_elements();
  state.counters["candidates"] = Counter(candidates, Counter::kAvgIterations);
  state.counters["factorizations"] = Counter(factorizations, Counter::kAvgIterations);
  state.counters["iterations_cg"] = Counter(iterations, Counter::kAvgIterations);
  state.counters["undone"] = grip.cycle().undone_steps;
  state.counters["flips"] = grip.cycle().seal_flips;
}

/// Times in the air beside sealed ones, step by step, so that the machine's drift is no part of
/// their ratio. Both cups' data pass through the same caches: either is slower than alone.
void CompareAir(benchmark::State& state, const char* bell, const Solver& solver) {
  GripSituation air(bell, Situation::kAir, solver.method, solver.threads);
  GripSituation sealed(bell, Situation::kSealed, solver.method, solver.threads);
  const OnOneCore on_one_core;
  StepStatistics air_statistics;
  std::vector<double> ratios;
  bool air_first = true;
  for (auto _ : state) {
    StepTime of_air{}, of_sealed{};
    if (air_first) of_air = TimeStep(&air);
    of_sealed = TimeStep(&sealed);
    if (!air_first) of_air = TimeStep(&air);
    air_first = !air_first;
    air_statistics.Add(of_air.cpu, of_air.wall);
    ratios.push_back(of_air.cpu / of_sealed.cpu);
  }
  air_statistics.Report({}, &state);
  state.counters["over_sealed"] = Quantile(std::move(ratios), 0.5);
}

/// Steps a grip once more and keeps where it started.
StepProblem Record(GripSituation* grip) {
  const double h = grip->cycle().simulator().parameters().time_step;
  const Eigen::Matrix3Xd x_before_W = grip->result().x_W;
  grip->Step();
  StepProblem problem;
  problem.x_W = grip->result().x_W;
  problem.v_W = (problem.x_W - x_before_W) / h;
  problem.wet = grip->result().classification.wet;
  grip->Step();
  problem.X_WM = grip->result().X_WM;
  problem.pressure = grip->result().gauge_pressure;
  problem.x_end_W = grip->result().x_W;
  return problem;
}

std::vector<RigidSurface> PlacedSurfaces(const Simulator& simulator) {
  RigidWorld world;
  world.SetObjects(simulator.objects());
  return world.surfaces();
}

/// Thread-CPU time of some steps in a row. [s]
double TimeOfSteps(GripSituation* grip, int num_steps) {
  double cpu = 0.0;
  for (int i = 0; i < num_steps; ++i) cpu += TimeStep(grip).cpu;
  return cpu;
}

/// The paper's step, from states of a situation on its way. Before each of them so many steps of
/// ours are timed, by every method, that the machine's drift is no part of the ratio. Its
/// factorisation, another thread's work in the paper, counts as little as that of our asynchronous
/// method.
void TimePaper(benchmark::State& state, const Bell& bell, Situation situation,
               PaperPipeline::Points points) {
  GripSituation direct(bell.name, situation, LinearSolverMethod::kDirect);
  GripSituation iterating(bell.name, situation, LinearSolverMethod::kConjugateGradient);
  GripSituation asynchronous(bell.name, situation, LinearSolverMethod::kAsynchronous);
  const Simulator& simulator = direct.cycle().simulator();
  PaperPipeline pipeline(simulator.mesh(), simulator.parameters(), PlacedSurfaces(simulator),
                         points);
  const OnOneCore on_one_core;
  StepStatistics statistics;
  PaperTimings sum;
  double direct_time = 0.0, iterating_time = 0.0, asynchronous_time = 0.0;
  double constraints = 0.0, difference = 0.0;
  const int num_between = bell.num_steps / bell.num_paper_steps;
  for (auto _ : state) {
    direct_time += TimeOfSteps(&direct, num_between);
    iterating_time += TimeOfSteps(&iterating, num_between);
    asynchronous_time += TimeOfSteps(&asynchronous, num_between);
    const StepProblem problem = Record(&direct);
    double wall = 0.0;
    const double begin = ThreadTime();
    const double factorization_before = sum.factorization;
    Eigen::Matrix3Xd x_W;
    {
      const Stopwatch stopwatch(&wall);
      x_W = pipeline.Step(problem, &sum);
    }
    const double factorization = sum.factorization - factorization_before;
    statistics.Add(ThreadTime() - begin - factorization, wall);
    constraints += pipeline.num_constraints();
    difference = std::max(difference, (x_W - problem.x_end_W).colwise().norm().maxCoeff());
  }
  statistics.Report({{"assembly", sum.assembly},
                     {"factorization", sum.factorization},
                     {"free_motion", sum.free_motion},
                     {"classification", sum.classification},
                     {"delassus", sum.delassus},
                     {"solve", sum.solve},
                     {"correction", sum.correction}},
                    &state);
  state.counters["elements"] = simulator.mesh().num_elements();
  state.counters["candidates"] =
      benchmark::Counter(constraints, benchmark::Counter::kAvgIterations);
  // How far its nodes end from the Simulator's, at most. [m]
  state.counters["difference"] = difference;
  // Mean step over ours.
  const double paper_time = statistics.total_cpu() * num_between;
  state.counters["over_direct"] = paper_time / direct_time;
  state.counters["over_conjugate_gradient"] = paper_time / iterating_time;
  state.counters["over_asynchronous"] = paper_time / asynchronous_time;
}

void RegisterAll() {
  const auto add = [](const std::string& title, int num_steps, const auto& function) {
    benchmark::RegisterBenchmark(title.c_str(), function)
        ->Iterations(num_steps)
        ->Unit(benchmark::kMillisecond);
  };
  for (const Bell& bell : kBells) {
    const char* const name = bell.name;
    for (const Solver& solver : kSolvers) {
      if (solver.threads > 1) continue;  // of which the clock of one tells nothing
      add(std::string(name) + "/air_beside_sealed/" + solver.name, bell.num_steps / 2,
          [=](benchmark::State& state) { CompareAir(state, name, solver); });
    }
    for (const auto& named : kSituations) {
      const Situation situation = named.situation;
      const bool cycle = situation == Situation::kCycle;
      const std::string title = std::string(name) + "/" + named.name + "/";
      for (const Solver& solver : kSolvers) {
        add(title + solver.name, cycle ? std::max(bell.num_steps, kStepsOfCycle) : bell.num_steps,
            [=](benchmark::State& state) { TimeSteps(state, name, situation, solver); });
      }
      if (cycle) continue;
      const auto add_paper = [&](const char* method, PaperPipeline::Points points) {
        add(title + method, bell.num_paper_steps,
            [=](benchmark::State& state) { TimePaper(state, bell, situation, points); });
      };
      add_paper("paper", PaperPipeline::Points::kNodesAndEdges);
      // Quadratic elements have a node on every edge: both are the same.
      if (title.find("linear") == 0) add_paper("paper_nodes", PaperPipeline::Points::kNodes);
    }
  }
  for (const Loop& loop : kLoops) {
    for (const Solver& solver : kSolvers) {
      if (solver.method == LinearSolverMethod::kAsynchronous) continue;  // no two runs are the same
      const std::string title =
          std::string(loop.bell) + "/loop_" + std::to_string(loop.rate) + "hz/" + solver.name;
      add(title, kRunsOfCycle, [=](benchmark::State& state) {
        TimeRepeatedCycle(state, loop.bell, loop.rate, solver.method, solver.threads);
      });
    }
  }
}

/// A line a case; the rest is for the JSON file.
class OneLine : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      const auto median = run.counters.find("cpu_median");
      const auto yardstick = run.counters.find("yardstick");
      if (median == run.counters.end() || yardstick == run.counters.end()) continue;
      const std::string name = run.run_name.function_name;
      std::printf("%-42s %9.3f ms  %8.3f yardsticks\n", name.c_str(), median->second.value,
                  median->second.value / yardstick->second.value);
    }
    std::fflush(stdout);
  }
};

}  // namespace
}  // namespace vacuum_gripper_sim

int main(int argc, char** argv) {
  vacuum_gripper_sim::RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  vacuum_gripper_sim::OneLine one_line;
  benchmark::RunSpecifiedBenchmarks(&one_line);
}
