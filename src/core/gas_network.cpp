#include "vacuum_gripper_sim/core/gas_network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "monotone_root.h"

namespace vacuum_gripper_sim {
namespace {

/// The equations of one sub-step of length dt: p V(p) - N - dt Q = 0 for every node.
struct SubStep {
  const std::vector<CupLineParameters>& lines;
  const std::vector<GasCup>& cups;
  const SourceFlow& source;
  const GasState& start;  // of the step
  const GasState& now;    // of the sub-step
  double manifold_volume;
  double ambient_pressure;
  bool check_valves_work;
  double dt;
  double progress{0.0};  // of the step at the sub-step's end, 0 to 1
  double time{0.0};      // there, since the step's start

  double Volume(std::size_t k, double p) const {
    const GasCup& cup = cups[k];
    const double cavity = std::max(cup.volume + cup.compliance * (p - cup.linear_at), 0.0);
    return (1.0 - progress) * start.volume[k] + progress * (lines[k].dead_volume + cavity);
  }

  /// Out of the manifold into cup k.
  double Hose(std::size_t k, double p_m, double p) const {
    const double area = lines[k].hose_area * cups[k].hose_opening;
    if (area <= 0.0 || (lines[k].check_valve && check_valves_work && p_m > p)) return 0.0;
    return OrificeThroughput(area, p_m, p);
  }

  double Leak(std::size_t k, double p) const {
    return cups[k].leak ? cups[k].leak(ambient_pressure, p) : 0.0;
  }

  /// Of cup k without its hose. [Pa m^3]
  double Residual(std::size_t k, double p) const {
    return p * Volume(k, p) - now.amount[k] - dt * Leak(k, p);
  }

  /// Of the manifold without its hoses. [Pa m^3]
  double ManifoldResidual(double p_m) const {
    return p_m * manifold_volume - now.manifold_amount - dt * source(p_m, time);
  }
};

/// Newton's method on all pressures at once. Each time the manifold's turns back, its steps are
/// bounded to half the last one: at kinks, as a regulator's flow has, they would go back and forth
/// for ever. @returns whether it converged.
bool SolveByNewton(const SubStep& step, EliminatedCups* eliminated, double* p_m,
                   std::vector<double>* pressure) {
  constexpr int kMaxIterations = 40;
  constexpr double kProbe = 1e-3;        // Pa, of the difference quotients
  constexpr double kLeastRemains = 0.2;  // of a pressure in one iteration: it stays positive
  const std::size_t n = pressure->size();
  double last_change = 0.0;
  double largest_change = std::numeric_limits<double>::infinity();
  std::vector<double>& shift = eliminated->shift;
  std::vector<double>& slope = eliminated->slope;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    // Eliminates the cups from the manifold's row, which is reduced to diagonal * dp_m = -reduced.
    const double tolerance = GasNetwork::kTolerance;
    double manifold_residual = step.ManifoldResidual(*p_m);
    double diagonal = (step.ManifoldResidual(*p_m + kProbe) - manifold_residual) / kProbe;
    double reduced = manifold_residual;
    bool converged = true;
    for (std::size_t k = 0; k < n; ++k) {
      const double p = (*pressure)[k];
      const double hose = step.Hose(k, *p_m, p);
      const double by_manifold = step.dt * (step.Hose(k, *p_m + kProbe, p) - hose) / kProbe;
      const double by_cup = step.dt * (step.Hose(k, *p_m, p + kProbe) - hose) / kProbe;
      const double own = step.Residual(k, p);
      const double own_slope = (step.Residual(k, p + kProbe) - own) / kProbe;
      const double cup_residual = own - step.dt * hose;
      converged = converged && std::abs(cup_residual) <= tolerance * step.Volume(k, p);
      shift[k] = -cup_residual / (own_slope - by_cup);
      slope[k] = by_manifold / (own_slope - by_cup);
      manifold_residual += step.dt * hose;
      reduced += step.dt * hose + by_cup * shift[k];
      diagonal += by_manifold + by_cup * slope[k];
    }
    converged = converged && std::abs(manifold_residual) <= tolerance * step.manifold_volume;
    if (converged) return true;

    double change = -reduced / diagonal;
    if (change * last_change < 0.0) largest_change = 0.5 * std::abs(last_change);
    change = std::clamp(change, -largest_change, largest_change);
    last_change = change;
    if (!std::isfinite(change)) return false;
    *p_m = std::max(*p_m + change, kLeastRemains * *p_m);
    for (std::size_t k = 0; k < n; ++k) {
      double& p = (*pressure)[k];
      p = std::max(p + shift[k] + slope[k] * change, kLeastRemains * p);
      if (!std::isfinite(p)) return false;
    }
  }
  return false;
}

/// Root of a rising function of a pressure that is not positive at 0 Pa.
template <typename Function>
double PressureRoot(const Function& f, double guess) {
  double upper = std::max(guess, 1.0);
  while (f(upper) < 0.0 && upper < 1e12) upper *= 2.0;
  return MonotoneRoot(f, 0.0, upper, 0.0);
}

/// Cups within the manifold's equation: slower, sure.
void SolveNested(const SubStep& step, double* p_m, std::vector<double>* pressure) {
  const auto cup_pressure = [&](std::size_t k, double manifold) {
    return PressureRoot(
        [&](double p) { return step.Residual(k, p) - step.dt * step.Hose(k, manifold, p); },
        (*pressure)[k]);
  };
  *p_m = PressureRoot(
      [&](double manifold) {
        double residual = step.ManifoldResidual(manifold);
        for (std::size_t k = 0; k < pressure->size(); ++k) {
          residual += step.dt * step.Hose(k, manifold, cup_pressure(k, manifold));
        }
        return residual;
      },
      step.ambient_pressure);
  for (std::size_t k = 0; k < pressure->size(); ++k) (*pressure)[k] = cup_pressure(k, *p_m);
}

/// Leads a pressure where its last change, repeated, would: a good start, since a regulator's
/// reference and most transients move steadily.
void Extrapolate(double* p, double* p_before) {
  const double next = std::max(2.0 * *p - *p_before, 0.5 * *p);
  *p_before = *p;
  *p = next;
}

}  // namespace

GasNetwork::GasNetwork(double manifold_volume, std::vector<CupLineParameters> lines,
                       double ambient_pressure)
    : manifold_volume_(manifold_volume),
      lines_(std::move(lines)),
      ambient_pressure_(ambient_pressure) {}

GasState GasNetwork::AtAmbient(const std::vector<double>& volumes) const {
  GasState state;
  state.manifold_amount = ambient_pressure_ * manifold_volume_;
  state.volume.resize(num_cups());
  state.amount.resize(num_cups());
  for (std::size_t k = 0; k < num_cups(); ++k) {
    state.volume[k] = volumes.at(k) + lines_[k].dead_volume;
    state.amount[k] = ambient_pressure_ * state.volume[k];
  }
  return state;
}

void GasNetwork::Solve(const GasState& start, const std::vector<GasCup>& cups,
                       const SourceFlow& source, bool check_valves_work, double h,
                       GasSolution* solution) const {
  const std::size_t n = num_cups();
  if (cups.size() != n || start.amount.size() != n || start.volume.size() != n) {
    throw std::invalid_argument("GasNetwork: state and cups must be of as many as its lines");
  }
  const int sub_steps = std::max(1, static_cast<int>(std::ceil(h / kLargestSubStep - 1e-9)));
  GasState& now = solution->end;
  now = start;
  std::vector<double>& pressure = solution->pressure;
  pressure.resize(n);
  for (std::size_t k = 0; k < n; ++k) pressure[k] = start.pressure(k);
  double p_m = manifold_pressure(start);
  solution->hose_flow.assign(n, 0.0);
  solution->leak_flow.assign(n, 0.0);
  solution->source_flow = 0.0;

  SubStep step{lines_,
               cups,
               source,
               start,
               now,
               manifold_volume_,
               ambient_pressure_,
               check_valves_work,
               h / sub_steps};
  eliminated_.shift.resize(n);
  eliminated_.slope.resize(n);
  pressure_before_ = pressure;
  double p_m_before = p_m;
  for (int i = 1; i <= sub_steps; ++i) {
    step.progress = static_cast<double>(i) / sub_steps;
    step.time = h * step.progress;
    Extrapolate(&p_m, &p_m_before);
    for (std::size_t k = 0; k < n; ++k) Extrapolate(&pressure[k], &pressure_before_[k]);
    if (!SolveByNewton(step, &eliminated_, &p_m, &pressure)) SolveNested(step, &p_m, &pressure);

    const double source_flow = source(p_m, step.time);
    solution->source_flow += source_flow / sub_steps;
    now.manifold_amount += step.dt * source_flow;
    for (std::size_t k = 0; k < n; ++k) {
      const double hose_flow = step.Hose(k, p_m, pressure[k]);
      const double leak_flow = step.Leak(k, pressure[k]);
      solution->hose_flow[k] += hose_flow / sub_steps;
      solution->leak_flow[k] += leak_flow / sub_steps;
      now.amount[k] += step.dt * (hose_flow + leak_flow);
      now.manifold_amount -= step.dt * hose_flow;
    }
  }
  solution->manifold_pressure = p_m;
  for (std::size_t k = 0; k < n; ++k) now.volume[k] = step.Volume(k, pressure[k]);
}

}  // namespace vacuum_gripper_sim
