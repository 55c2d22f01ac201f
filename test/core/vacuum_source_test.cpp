#include "vacuum_gripper_sim/core/vacuum_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

constexpr double kAmbient = air::kAmbientPressure;

VacuumParameters Parameters(VacuumSourceType type) {
  VacuumParameters parameters;
  parameters.source = type;
  return parameters;
}

double Duration(const StepInterval& interval) { return interval.end - interval.begin; }

TEST(VacuumSource, ThroughputNeverRisesIsContinuousAndNeverDrawsFromNothing) {
  for (const auto type :
       {VacuumSourceType::kRegulator, VacuumSourceType::kEjector, VacuumSourceType::kPump,
        VacuumSourceType::kPassive, VacuumSourceType::kVented}) {
    for (const bool lost : {false, true}) {
      for (const double time : {0.01, 0.05, 0.2}) {  // on, blow-off, off
        VacuumSource source(Parameters(type));
        source.SetPumpLost(lost);
        source.Begin(-6e4, 0.1);
        source.Begin(0.0, 0.2);
        EXPECT_GE(source.Throughput(0.0, time), 0.0);
        for (double p = 0.0; p < 1.3 * kAmbient; p += 5.0) {
          const double fall = source.Throughput(p, time) - source.Throughput(p + 5.0, time);
          EXPECT_GE(fall, 0.0) << static_cast<int>(type) << " at " << p;
          EXPECT_LT(fall, 15.0) << static_cast<int>(type) << " at " << p;
        }
      }
    }
  }
}

TEST(VacuumSource, IdealRegulatorHasNoFlow) {
  EXPECT_THROW(VacuumSource(Parameters(VacuumSourceType::kIdealRegulator)), std::invalid_argument);
}

TEST(VacuumSource, ValveSwitchesAfterItsDelays) {
  VacuumParameters parameters = Parameters(VacuumSourceType::kEjector);
  parameters.valve.on_delay = 0.015;
  parameters.valve.off_delay = 0.02;
  parameters.valve.blow_off_duration = 0.025;
  for (const double h : {0.001, 0.01}) {
    VacuumSource source(parameters);
    double on_time = 0.0, blow_off_time = 0.0;
    const auto run = [&](double setpoint, double duration) {
      for (int i = 0; i < std::lround(duration / h); ++i) {
        source.Begin(setpoint, h);
        on_time += Duration(source.state().on);
        blow_off_time += Duration(source.state().blow_off);
      }
    };
    run(-6e4, 0.01);
    EXPECT_FALSE(source.on());
    EXPECT_EQ(on_time, 0.0);
    run(-6e4, 0.01);
    EXPECT_TRUE(source.on());
    EXPECT_NEAR(on_time, 0.005, 1e-9);
    run(0.0, 0.01);
    EXPECT_TRUE(source.on());
    run(0.0, 0.01);
    EXPECT_NEAR(on_time, 0.025, 1e-9);
    run(0.0, 0.02);
    EXPECT_EQ(source.state().phase, ValvePhase::kBlowOff);
    EXPECT_NEAR(blow_off_time, 0.02, 1e-9);
    run(0.0, 0.02);
    EXPECT_EQ(source.state().phase, ValvePhase::kOff);
    EXPECT_NEAR(blow_off_time, 0.025, 1e-9);
    EXPECT_NEAR(on_time, 0.025, 1e-9);
  }
}

TEST(VacuumSource, RevokedCommandHasNoEffectAndANewOneWaitsAnew) {
  VacuumParameters parameters = Parameters(VacuumSourceType::kPump);
  parameters.valve.on_delay = 0.015;
  VacuumSource source(parameters);
  source.Begin(-6e4, 0.01);
  source.Begin(0.0, 0.01);   // revoked after 10 ms
  source.Begin(-6e4, 0.01);  // 10 ms anew
  EXPECT_FALSE(source.on());
  EXPECT_EQ(Duration(source.state().blow_off), 0.0);  // was never on
  source.Begin(-6e4, 0.01);
  EXPECT_TRUE(source.on());
  EXPECT_NEAR(source.state().on.begin, 0.005, 1e-9);
  EXPECT_NEAR(source.state().on.end, 0.01, 1e-9);
  source.Begin(0.0, 0.01);  // of 15 ms
  source.Begin(-6e4, 0.01);
  EXPECT_TRUE(source.on());
  EXPECT_NEAR(Duration(source.state().on), 0.01, 1e-12);
}

TEST(VacuumSource, SwitchesWithinTheStep) {
  VacuumParameters parameters = Parameters(VacuumSourceType::kEjector);
  parameters.valve.on_delay = 0.004;
  parameters.valve.off_delay = 0.006;
  parameters.valve.blow_off_duration = 0.01;
  VacuumSource source(parameters);
  const auto phase = [&](double time) {
    const double flow = source.Throughput(kAmbient, time);
    return flow < 0.0 ? "on" : flow > 0.0 ? "blow-off" : "off";
  };
  source.Begin(-6e4, 0.02);
  EXPECT_STREQ(phase(0.004), "off");
  EXPECT_STREQ(phase(0.0041), "on");
  EXPECT_STREQ(phase(0.02), "on");
  source.Begin(0.0, 0.02);
  EXPECT_STREQ(phase(0.006), "on");
  EXPECT_STREQ(phase(0.0061), "blow-off");
  EXPECT_STREQ(phase(0.016), "blow-off");
  EXPECT_STREQ(phase(0.0161), "off");
  source.Begin(-6e4, 0.02);
  source.Begin(0.0, 0.01);
  source.Begin(-6e4, 0.02);  // again during the blow-off
  EXPECT_STREQ(phase(0.004), "blow-off");
  EXPECT_STREQ(phase(0.0041), "on");
}

TEST(VacuumSource, RestoredStateRepeatsTheStep) {
  VacuumSource source(Parameters(VacuumSourceType::kEjector));
  source.Begin(-6e4, 0.01);
  const VacuumSourceState before = source.state();
  source.Begin(-6e4, 0.01);
  const double flow = source.Throughput(8e4, 0.002);
  source.Begin(-6e4, 0.01);
  EXPECT_NE(source.Throughput(8e4, 0.002), flow);
  source.set_state(before);
  source.Begin(-6e4, 0.01);
  EXPECT_EQ(source.Throughput(8e4, 0.002), flow);
}

TEST(VacuumSource, EjectorDrawsItsCurveWhateverTheSetpoint) {
  VacuumSource source(Parameters(VacuumSourceType::kEjector));
  for (const double setpoint : {-1e3, -8e4}) {
    source.Begin(setpoint, 0.1);
    source.Begin(setpoint, 0.1);
    EXPECT_NEAR(source.Throughput(kAmbient, 0.05), -2e-4 * kAmbient, 1e-12);
    EXPECT_NEAR(source.Throughput(kAmbient - 42.5e3, 0.05), -1e-4 * kAmbient, 1e-12);
    EXPECT_EQ(source.Throughput(kAmbient - 85e3, 0.05), 0.0);
    EXPECT_EQ(source.Throughput(kAmbient - 95e3, 0.05), 0.0);
  }
}

TEST(VacuumSource, BlowOffPressesAgainstTheVentAndEnds) {
  VacuumParameters parameters = Parameters(VacuumSourceType::kEjector);
  parameters.valve.off_delay = 0.0;
  parameters.valve.blow_off_duration = 0.05;
  VacuumSource source(parameters);
  source.Begin(-6e4, 0.1);
  source.Begin(0.0, 0.01);
  EXPECT_NEAR(source.Throughput(kAmbient, 0.005), parameters.valve.blow_off_flow * kAmbient, 1e-12);
  EXPECT_LT(source.Throughput(1.5 * kAmbient, 0.005), 0.0);  // no more than this in a closed cup
  source.Begin(0.0, 0.05);
  source.Begin(0.0, 0.01);
  EXPECT_EQ(source.Throughput(kAmbient, 0.005), 0.0);
  EXPECT_EQ(source.Throughput(5e4, 0.005),
            OrificeThroughput(parameters.valve.vent_area, kAmbient, 5e4));
}

TEST(VacuumSource, LostSupplyVentsAnEjectorAndClosesAPump) {
  VacuumSource ejector(Parameters(VacuumSourceType::kEjector));
  VacuumSource pump(Parameters(VacuumSourceType::kPump));
  VacuumSource regulator(Parameters(VacuumSourceType::kRegulator));
  for (VacuumSource* source : {&ejector, &pump, &regulator}) {
    source->Begin(-6e4, 1.0);
    source->Begin(-6e4, 1.0);
    const double drawn = source->Throughput(6e4, 0.5);
    EXPECT_LT(drawn, 0.0);
    source->SetPumpLost(true);
    EXPECT_GE(source->Throughput(6e4, 0.5), 0.0);
    source->SetPumpLost(false);
    EXPECT_EQ(source->Throughput(6e4, 0.5), drawn);  // recovers
    source->SetPumpLost(true);
  }
  const double vent = OrificeThroughput(VacuumValveParameters{}.vent_area, kAmbient, 6e4);
  EXPECT_EQ(ejector.Throughput(6e4, 0.5), vent);
  EXPECT_EQ(pump.Throughput(6e4, 0.5), 0.0);
  EXPECT_EQ(regulator.Throughput(6e4, 0.5), 0.0);
  EXPECT_GT(regulator.Throughput(3e4, 0.5), 0.0);
  EXPECT_LT(regulator.Throughput(1.1 * kAmbient, 0.5), 0.0);
  ejector.Begin(0.0, 0.02);
  EXPECT_EQ(ejector.Throughput(6e4, 0.01), vent);  // no air for the blow-off either
  pump.Begin(0.0, 0.015);
  pump.Begin(0.0, 0.1);
  EXPECT_GT(pump.Throughput(6e4, 0.05), vent);  // vented and blown off
}

TEST(VacuumSource, RegulatorsReferenceLagsAndIsLimited) {
  VacuumParameters parameters = Parameters(VacuumSourceType::kRegulator);
  parameters.regulator.time_constant = 0.05;
  parameters.regulator.rate_limit = 4e5;  // reached while the error is above 20 kPa
  for (const double h : {0.001, 0.01}) {
    VacuumSource source(parameters);
    for (int i = 1; i <= std::lround(0.3 / h); ++i) {
      source.Begin(-6e4, h);
      const double t = i * h;
      const double expected = t < 0.1 ? -4e5 * t : -6e4 + 2e4 * std::exp(-(t - 0.1) / 0.05);
      EXPECT_NEAR(source.state().reference, expected, 1e-6) << t;
    }
    for (int i = 1; i <= std::lround(0.05 / h); ++i) source.Begin(0.0, h);
    EXPECT_NEAR(source.state().reference, -6e4 + 2e4 * std::exp(-4.0) + 2e4, 400.0);
  }
}

TEST(VacuumSource, RegulatorWithoutLagMeetsItsSetpoint) {
  VacuumParameters parameters = Parameters(VacuumSourceType::kRegulator);
  parameters.regulator.time_constant = 0.0;
  VacuumSource source(parameters);
  source.Begin(-6e4, 0.1);
  EXPECT_NEAR(source.state().reference, -5e4, 1e-9);
  source.Begin(-6e4, 0.1);
  EXPECT_EQ(source.state().reference, -6e4);
}

TEST(VacuumSource, RegulatorsValveIsSteepAndSaturates) {
  VacuumParameters parameters = Parameters(VacuumSourceType::kRegulator);
  VacuumSource source(parameters);
  source.Begin(-6e4, 10.0);
  const double reference = kAmbient - 6e4;
  const double supply = parameters.regulator.supply_flow * kAmbient;
  EXPECT_NEAR(source.Throughput(reference, 10.0), 0.0, 1e-9 * supply);
  EXPECT_NEAR(source.Throughput(reference + 10.0, 10.0), -0.5 * supply, 1e-9 * supply);
  EXPECT_EQ(source.Throughput(reference + 30.0, 10.0), -supply);
  EXPECT_EQ(source.Throughput(kAmbient, 10.0), -supply);
  EXPECT_EQ(source.Throughput(2e4, 10.0),
            OrificeThroughput(parameters.valve.vent_area, kAmbient, 2e4));
}

TEST(VacuumSource, HoldsALeakSmallerThanItsFlowThere) {
  VacuumSource source(Parameters(VacuumSourceType::kEjector));
  const double drawn = 1e-4 * kAmbient;
  EXPECT_TRUE(source.CanHold(-42.5e3, [&](double) { return 0.99 * drawn; }));
  EXPECT_FALSE(source.CanHold(-42.5e3, [&](double) { return 1.01 * drawn; }));
  source.SetPumpLost(true);
  const auto tight = [](double) { return 0.0; };
  EXPECT_FALSE(source.CanHold(-42.5e3, tight));
  source.SetPumpLost(false);
  EXPECT_TRUE(source.CanHold(-42.5e3, tight));
  EXPECT_FALSE(source.CanHold(-86e3, tight));  // beyond the ultimate vacuum
  EXPECT_FALSE(source.CanHold(0.0, tight));
}

}  // namespace
}  // namespace vacuum_gripper_sim
