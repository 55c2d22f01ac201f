#include "vacuum_gripper_sim/core/gas_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <vector>

#include "vacuum_gripper_sim/core/vacuum_source.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kAmbient = air::kAmbientPressure;
constexpr double kSpeed = 290.086;  // sqrt(R T) [m/s]

LeakFlow Orifice(double area) {
  return [area](double p_from, double p_to) { return OrificeThroughput(area, p_from, p_to); };
}

double NoFlow(double, double) { return 0.0; }

GasCup Rigid(double volume, LeakFlow leak = nullptr) {
  GasCup cup;
  cup.volume = volume;
  cup.leak = std::move(leak);
  return cup;
}

/// p after dp/dt = rate(t, p) from p_0 for a time, by the classical Runge-Kutta method.
double Quadrature(const std::function<double(double, double)>& rate, double p_0, double time) {
  const int steps = 4000;
  const double dt = time / steps;
  double p = p_0;
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt;
    const double k_1 = rate(t, p);
    const double k_2 = rate(t + 0.5 * dt, p + 0.5 * dt * k_1);
    const double k_3 = rate(t + 0.5 * dt, p + 0.5 * dt * k_2);
    const double k_4 = rate(t + dt, p + dt * k_3);
    p += dt / 6.0 * (k_1 + 2.0 * k_2 + 2.0 * k_3 + k_4);
  }
  return p;
}

/// A step that is committed at once.
void Advance(const GasNetwork& network, const std::vector<GasCup>& cups, const SourceFlow& source,
             double h, GasState* state, GasSolution* solution) {
  network.Solve(*state, cups, source, true, h, solution);
  *state = solution->end;
}

TEST(GasNetwork, EvacuatesThroughAnOrificeExponentiallyWhileChoked) {
  const double volume = 1e-5, time_constant = 0.05;
  const double area = volume / (time_constant * 0.684731 * kSpeed);
  const double p_far = 2e4;  // critical at 37.9 kPa
  const auto flow = [&](double p, double) { return -OrificeThroughput(area, p, p_far); };
  const GasNetwork network(volume, {}, kAmbient);
  for (const double h : {0.001, 0.01}) {
    GasState state = network.AtAmbient({});
    GasSolution solution;
    for (int i = 1; i <= std::lround(0.2 / h); ++i) {
      Advance(network, {}, flow, h, &state, &solution);
      const double t = i * h;
      const double exact =
          Quadrature([&](double, double p) { return flow(p, 0.0) / volume; }, kAmbient, t);
      if (t < 0.049) {
        EXPECT_NEAR(exact, kAmbient * std::exp(-t / time_constant), 1e-4 * exact);
      }
      EXPECT_NEAR(solution.manifold_pressure, exact, 0.01 * exact) << "h = " << h << ", " << t;
    }
    EXPECT_NEAR(solution.manifold_pressure, p_far, 1.0);  // there after .2 s
  }
}

TEST(GasNetwork, FillsThroughAnOrificeLinearlyWhileChoked) {
  const double volume = 1e-5, area = 4e-7;
  CupLineParameters line;
  line.dead_volume = 4e-6;
  const GasNetwork network(1e-6, {line}, kAmbient);
  GasCup cup = Rigid(6e-6, Orifice(area));
  cup.hose_opening = 0.0;
  const auto rate = [&](double, double p) { return OrificeThroughput(area, kAmbient, p) / volume; };
  for (const double h : {0.001, 0.01}) {
    GasState state = network.AtAmbient({6e-6});
    state.amount[0] = 1e4 * volume;
    GasSolution solution;
    for (int i = 1; i <= std::lround(0.2 / h); ++i) {
      Advance(network, {cup}, NoFlow, h, &state, &solution);
      const double exact = Quadrature(rate, 1e4, i * h);
      if (exact < 0.528 * kAmbient) {
        EXPECT_NEAR(exact, 1e4 + i * h * 0.684731 * area * kAmbient * kSpeed / volume, 10.0);
      }
      EXPECT_NEAR(solution.pressure[0], exact, 0.01 * exact) << "h = " << h << ", " << i * h;
      EXPECT_LE(solution.pressure[0], kAmbient + 1e-6);
    }
    EXPECT_NEAR(solution.pressure[0], kAmbient, 1e-3);
  }
}

TEST(GasNetwork, ClosedCupKeepsPV) {
  const GasNetwork network(1e-6, {CupLineParameters{}}, kAmbient);
  GasState state = network.AtAmbient({5e-6});
  const double amount = state.amount[0];
  GasSolution solution;
  for (int i = 0; i < 50; ++i) {
    GasCup cup = Rigid(5e-6 + 3e-6 * std::sin(0.4 * i));
    cup.hose_opening = 0.0;
    Advance(network, {cup}, NoFlow, 0.01, &state, &solution);
    const double volume = cup.volume + CupLineParameters{}.dead_volume;
    EXPECT_NEAR(solution.pressure[0] * volume, amount, 1e-9 * amount);
  }
}

TEST(GasNetwork, PassiveSystemKeepsTheSumOfPV) {
  const GasNetwork network(5e-6, {CupLineParameters{}}, kAmbient);
  GasState state = network.AtAmbient({5e-6});
  GasSolution solution;
  for (int i = 0; i < 50; ++i) Advance(network, {Rigid(9e-6)}, NoFlow, 0.01, &state, &solution);
  const double expected = kAmbient * 14e-6 / 18e-6;
  EXPECT_NEAR(solution.pressure[0], expected, 1e-9 * expected);
  EXPECT_NEAR(solution.manifold_pressure, expected, 1e-9 * expected);
}

TEST(GasNetwork, SqueezedCupBreathesThroughItsLeakTheSameForAnyStep) {
  const double area = 1e-6, dead_volume = CupLineParameters{}.dead_volume;
  const auto cavity = [](double t) { return 6e-6 - 1e-4 * t; };  // 6 to 1 cm^3 in 50 ms
  const auto rate = [&](double t, double p) {
    const double outflow = OrificeThroughput(area, p, kAmbient);
    return (1e-4 * p - outflow) / (cavity(t) + dead_volume);
  };
  const GasNetwork network(1e-6, {CupLineParameters{}}, kAmbient);
  for (const double h : {0.001, 0.01}) {
    GasState state = network.AtAmbient({cavity(0.0)});
    GasSolution solution;
    for (int i = 1; i <= std::lround(0.05 / h); ++i) {
      GasCup cup = Rigid(cavity(i * h), Orifice(area));
      cup.hose_opening = 0.0;
      Advance(network, {cup}, NoFlow, h, &state, &solution);
      const double exact = Quadrature(rate, kAmbient, i * h);
      EXPECT_NEAR(solution.pressure[0], exact, 0.001 * exact) << "h = " << h << ", " << i;
    }
    EXPECT_GT(solution.pressure[0], 1.05 * kAmbient);
  }
}

TEST(GasNetwork, ComplianceIsPartOfTheSolution) {
  // p (V_0 + C (p - p_0)) = N has a closed form.
  CupLineParameters line;
  line.dead_volume = 2e-6;
  const GasNetwork network(1e-6, {line}, kAmbient);
  GasState state = network.AtAmbient({8e-6});
  GasCup cup = Rigid(12e-6);
  cup.compliance = 1e-10;
  cup.linear_at = 9e4;
  cup.hose_opening = 0.0;
  GasSolution solution;
  network.Solve(state, {cup}, NoFlow, true, 0.01, &solution);
  const double b = 14e-6 - 1e-10 * 9e4, amount = kAmbient * 10e-6;
  const double p = (-b + std::sqrt(b * b + 4e-10 * amount)) / 2e-10;
  EXPECT_NEAR(solution.pressure[0], p, 1e-6);
  EXPECT_NEAR(solution.end.volume[0], b + 1e-10 * p, 1e-15);
  EXPECT_NEAR(solution.end.pressure(0), p, 1e-6);
  EXPECT_EQ(state.amount[0], network.AtAmbient({8e-6}).amount[0]);  // solving changed nothing
}

TEST(GasNetwork, CavityIsNeverLessThanEmpty) {
  CupLineParameters line;
  line.dead_volume = 2e-6;
  const GasNetwork network(1e-6, {line}, kAmbient);
  const GasState state = network.AtAmbient({2e-6});
  GasCup cup = Rigid(-5e-6);
  cup.hose_opening = 0.0;
  GasSolution solution;
  network.Solve(state, {cup}, NoFlow, true, 0.01, &solution);
  EXPECT_NEAR(solution.pressure[0], 2.0 * kAmbient, 1e-6);
}

TEST(GasNetwork, EjectorSettlesWhereItsCurveMeetsTheLeak) {
  VacuumParameters parameters;
  parameters.source = VacuumSourceType::kEjector;
  parameters.line.hose_area = 1e-4;  // wide: the pressure is one
  const double area = 3e-7;
  const GasNetwork network(parameters.manifold_volume, {parameters.line}, kAmbient);
  for (const double h : {0.001, 0.01}) {
    VacuumSource source(parameters);
    GasState state = network.AtAmbient({5e-6});
    GasSolution solution;
    for (int i = 0; i < std::lround(1.0 / h); ++i) {
      source.Begin(-6e4, h);
      Advance(
          network, {Rigid(5e-6, Orifice(area))},
          [&](double p, double t) { return source.Throughput(p, t); }, h, &state, &solution);
    }
    // Choked leak .6847 A p_a c against the line 2e-4 p_a (1 + g / 85 kPa).
    const double gauge = -85e3 * (1.0 - 0.684731 * area * kSpeed / 2e-4);
    ASSERT_LT(kAmbient + gauge, 0.528 * kAmbient);
    EXPECT_NEAR(solution.pressure[0] - kAmbient, gauge, 0.005 * -gauge);
    EXPECT_NEAR(solution.leak_flow[0], -solution.source_flow, 1e-6 * solution.leak_flow[0]);
    EXPECT_TRUE(source.CanHold(-6e4, [&](double p) {
      return OrificeThroughput(area, kAmbient, p);
    }) == (gauge < -6e4));
  }
}

TEST(GasNetwork, MassIsConservedOverAGrip) {
  VacuumParameters parameters;
  parameters.source = VacuumSourceType::kEjector;
  parameters.line.check_valve = true;
  const GasNetwork network(parameters.manifold_volume, {3, parameters.line}, kAmbient);
  VacuumSource source(parameters);
  GasState state = network.AtAmbient({4e-6, 5e-6, 6e-6});
  GasSolution solution;
  const auto total = [&]() {
    double sum = state.manifold_amount;
    for (const double amount : state.amount) sum += amount;
    return sum;
  };
  const double before = total();
  double entered = 0.0, moved = 0.0, lowest = kAmbient, highest = kAmbient;
  const double h = 0.01;
  for (int i = 0; i < 150; ++i) {
    source.Begin(i < 70 ? -6e4 : 0.0, h);
    std::vector<GasCup> cups{Rigid(4e-6, Orifice(1e-8)), Rigid(5e-6, Orifice(2e-7)), Rigid(6e-6)};
    for (GasCup& cup : cups) {
      cup.compliance = 2e-11;
      cup.linear_at = kAmbient;
    }
    if (i > 40) cups[1].leak = Orifice(5e-5);  // lets go
    network.Solve(
        state, cups, [&](double p, double t) { return source.Throughput(p, t); }, source.on(), h,
        &solution);
    const double start = total();
    double step_entered = h * solution.source_flow;
    for (const double flow : solution.leak_flow) step_entered += h * flow;
    state = solution.end;
    EXPECT_NEAR(total() - start, step_entered, 1e-12 * before);
    entered += step_entered;
    moved += std::abs(step_entered);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(state.pressure(k), solution.pressure[k], 1e-6);
    }
    EXPECT_NEAR(network.manifold_pressure(state), solution.manifold_pressure, 1e-6);
    lowest = std::min(lowest, solution.pressure[2]);
    highest = std::max(highest, solution.pressure[2]);
    if (i == 69) {
      EXPECT_GT(solution.pressure[1], 0.98 * kAmbient);
      EXPECT_LT(solution.pressure[2], lowest + 1.0);  // kept by its check valve
    }
  }
  EXPECT_LT(lowest, kAmbient - 4e4);
  EXPECT_GT(highest, kAmbient);  // blown off
  EXPECT_GT(moved, 0.5 * before);
  EXPECT_NEAR(total() - before, entered, 1e-9 * before);
}

TEST(GasNetwork, DoesNotDependOnTheStep) {
  // A grip with delays that no step divides, a leak, and cups that are drawn flat meanwhile.
  for (const auto type : {VacuumSourceType::kRegulator, VacuumSourceType::kEjector}) {
    VacuumParameters parameters;
    parameters.source = type;
    parameters.valve.on_delay = 0.0175;
    parameters.valve.off_delay = 0.0125;
    const GasNetwork network(parameters.manifold_volume, {2, parameters.line}, kAmbient);
    const auto trace = [&](double h) {
      VacuumSource source(parameters);
      GasState state = network.AtAmbient({8e-6, 8e-6});
      GasSolution solution;
      std::vector<double> pressures;
      for (int i = 0; i < std::lround(0.6 / h); ++i) {
        source.Begin(i * h < 0.4 - 1e-9 ? -5e4 : 0.0, h);
        std::vector<GasCup> cups{Rigid(8e-6, Orifice(1e-7)), Rigid(8e-6)};
        for (GasCup& cup : cups) {
          cup.compliance = 5e-11;
          cup.linear_at = kAmbient;
        }
        Advance(
            network, cups, [&](double p, double t) { return source.Throughput(p, t); }, h, &state,
            &solution);
        if ((i + 1) % std::lround(0.01 / h) == 0) pressures.push_back(solution.pressure[0]);
      }
      return pressures;
    };
    const std::vector<double> fine = trace(0.001);
    EXPECT_LT(fine[39], kAmbient - 4.9e4);
    EXPECT_GT(fine[59], kAmbient - 2e3);
    for (const double h : {0.002, 0.005, 0.01}) {
      const std::vector<double> coarse = trace(h);
      for (std::size_t i = 0; i < fine.size(); ++i) {
        EXPECT_NEAR(coarse[i], fine[i], 0.01 * fine[i]) << "h = " << h << ", sample " << i;
      }
    }
  }
}

TEST(GasNetwork, CheckValveKeepsTheVacuumUntilItIsOpened) {
  CupLineParameters line;
  line.check_valve = true;
  const GasNetwork network(5e-6, {line}, kAmbient);
  GasState state = network.AtAmbient({5e-6});
  state.amount[0] *= 0.4;
  GasSolution solution;
  network.Solve(state, {Rigid(5e-6)}, NoFlow, true, 0.01, &solution);
  EXPECT_EQ(solution.end.amount[0], state.amount[0]);
  network.Solve(state, {Rigid(5e-6)}, NoFlow, false, 0.01, &solution);
  EXPECT_GT(solution.end.amount[0], 1.5 * state.amount[0]);
  state.amount[0] /= 0.3;  // above the manifold: out at any rate
  network.Solve(state, {Rigid(5e-6)}, NoFlow, true, 0.01, &solution);
  EXPECT_LT(solution.end.amount[0], 0.95 * state.amount[0]);
}

TEST(GasNetwork, KinkedHoseSlowsAndClosedOneCutsOff) {
  const GasNetwork network(5e-6, {1, CupLineParameters{}}, kAmbient);
  GasState state = network.AtAmbient({5e-6});
  state.manifold_amount *= 0.2;
  GasSolution solution;
  std::vector<double> flows;
  for (const double opening : {1.0, 0.1, 0.0}) {
    GasCup cup = Rigid(5e-6);
    cup.hose_opening = opening;
    network.Solve(state, {cup}, NoFlow, true, 0.0001, &solution);
    flows.push_back(-solution.hose_flow[0]);
  }
  EXPECT_GT(flows[0], 5.0 * flows[1]);
  EXPECT_GT(flows[1], 0.0);
  EXPECT_EQ(flows[2], 0.0);
}

TEST(GasNetwork, SolvesItsEquationsWhateverTheScales) {
  std::mt19937_64 random(7);
  const auto between = [&](double low, double high) {  // log-uniform
    const double u = static_cast<double>(random() >> 11) * 0x1p-53;
    return low * std::pow(high / low, u);
  };
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<CupLineParameters> lines(4);
    std::vector<GasCup> cups;
    for (CupLineParameters& line : lines) {
      line = {between(1e-7, 1e-4), between(1e-8, 1e-3), random() % 2 == 0};
      cups.push_back(Rigid(between(1e-8, 1e-4), Orifice(between(1e-12, 3e-4))));
      cups.back().compliance = between(1e-14, 1e-9);
      cups.back().linear_at = kAmbient;
    }
    const GasNetwork network(between(1e-7, 1e-4), lines, kAmbient);
    GasState start = network.AtAmbient(std::vector<double>(4, between(1e-8, 1e-4)));
    for (double& amount : start.amount) amount *= between(0.02, 2.0);
    start.manifold_amount *= between(0.02, 2.0);
    SuctionCurve curve;
    curve.free_flow = between(1e-6, 1e-1);
    const auto source = [&](double p, double) {
      return -SuctionFlow(curve, p - kAmbient) * kAmbient;
    };
    GasSolution solution;
    network.Solve(start, cups, source, true, 0.01, &solution);
    for (std::size_t k = 0; k < cups.size(); ++k) {
      const double volume =
          lines[k].dead_volume +
          std::max(cups[k].volume + cups[k].compliance * (solution.pressure[k] - kAmbient), 0.0);
      EXPECT_NEAR(solution.end.volume[k], volume, 1e-12 * volume);
      EXPECT_NEAR(solution.end.pressure(k), solution.pressure[k], 1e-6) << trial;
      EXPECT_GT(solution.pressure[k], 0.0);
    }
    EXPECT_NEAR(network.manifold_pressure(solution.end), solution.manifold_pressure, 1e-6) << trial;
  }
}

TEST(GasNetwork, RefusesAnotherNumberOfCups) {
  const GasNetwork network(5e-6, {2, CupLineParameters{}}, kAmbient);
  GasSolution solution;
  EXPECT_THROW(
      network.Solve(network.AtAmbient({1e-6, 1e-6}), {Rigid(1e-6)}, NoFlow, true, 0.01, &solution),
      std::invalid_argument);
}

}  // namespace
}  // namespace vacuum_gripper_sim
