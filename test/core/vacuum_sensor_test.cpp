#include "vacuum_gripper_sim/core/vacuum_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

constexpr double kAmbient = air::kAmbientPressure;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Reads what is there, at once.
VacuumSensorParameters Perfect() {
  VacuumSensorParameters parameters;
  parameters.rate = 1000.0;
  parameters.delay = 0.0;
  parameters.pressure_noise = 0.0;
  parameters.pressure_resolution = 0.0;
  parameters.hold_time = 0.0;
  return parameters;
}

VacuumTruth At(double time, double gauge, double setpoint = -6e4) {
  VacuumTruth truth;
  truth.time = time;
  truth.absolute_pressure = kAmbient + gauge;
  truth.flow = 1e-4;
  truth.setpoint = setpoint;
  truth.on = setpoint < 0.0;
  return truth;
}

TEST(VacuumSensor, ReadsAmbientBeforeItsFirstSampleIsOut) {
  VacuumSensorParameters parameters = Perfect();
  parameters.delay = 0.01;
  VacuumSensor sensor(parameters);
  const VacuumReading& reading = sensor.Update(At(0.0, -5e4));
  EXPECT_EQ(reading.absolute_pressure, kAmbient);
  EXPECT_FALSE(reading.is_new || reading.part_present || reading.part_detached);
}

TEST(VacuumSensor, SamplesAtItsOwnRateOverAnyStep) {
  VacuumSensorParameters parameters = Perfect();
  parameters.rate = 38.0;
  for (const double h : {0.001, 0.01}) {
    VacuumSensor sensor(parameters);
    int samples = 0;
    double last = 0.0;
    for (int i = 0; i <= std::lround(10.0 / h); ++i) {
      const VacuumReading& reading = sensor.Update(At(i * h, -1.0 * i));
      if (reading.is_new) {
        EXPECT_NEAR(reading.time, samples / 38.0, h);  // never drifts
        EXPECT_GE(reading.time, samples / 38.0 - 1e-9);
        last = -1.0 * i;
        ++samples;
      }
      EXPECT_EQ(reading.absolute_pressure, kAmbient + last);  // stands between samples
    }
    EXPECT_EQ(samples, 381);
  }
}

TEST(VacuumSensor, FasterThanTheStepItReadsEveryStep) {
  VacuumSensor sensor(Perfect());
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(sensor.Update(At(0.01 * i, -1e3 * i)).is_new);
    EXPECT_EQ(sensor.reading().absolute_pressure, kAmbient - 1e3 * i);
  }
}

TEST(VacuumSensor, OutputComesAfterTheDelay) {
  VacuumSensorParameters parameters = Perfect();
  parameters.delay = 0.025;
  VacuumSensor sensor(parameters);
  for (int i = 0; i < 100; ++i) {
    const double time = 0.001 * i;
    const VacuumReading& reading = sensor.Update(At(time, -1e3 * i));
    if (i < 25) {
      EXPECT_FALSE(reading.is_new);
    } else {
      EXPECT_NEAR(reading.time, time - 0.025, 1e-12);
      EXPECT_EQ(reading.absolute_pressure, kAmbient - 1e3 * (i - 25));
    }
  }
}

TEST(VacuumSensor, NoiseHasItsDeviationAndRepeatsWithTheSeed) {
  VacuumSensorParameters parameters = Perfect();
  parameters.pressure_noise = 50.0;
  parameters.flow_noise = 1e-6;
  VacuumSensor sensor(parameters), twin(parameters);
  parameters.seed = 2;
  VacuumSensor other(parameters);
  const int n = 20000;
  double sum = 0.0, squares = 0.0, flow_squares = 0.0, mixed = 0.0;
  int beyond_two = 0;
  std::vector<double> first;
  for (int i = 0; i < n; ++i) {
    const VacuumTruth truth = At(0.001 * i, -3e4);
    const VacuumReading& reading = sensor.Update(truth);
    EXPECT_EQ(reading.absolute_pressure, twin.Update(truth).absolute_pressure);
    EXPECT_NE(reading.absolute_pressure, other.Update(truth).absolute_pressure);
    const double e = reading.absolute_pressure - truth.absolute_pressure;
    const double e_flow = reading.flow - truth.flow;
    if (i < 10) first.push_back(reading.absolute_pressure);
    sum += e;
    squares += e * e;
    flow_squares += e_flow * e_flow;
    mixed += e * e_flow;
    if (std::abs(e) > 100.0) ++beyond_two;
  }
  EXPECT_NEAR(sum / n, 0.0, 4.0 * 50.0 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 50.0, 1.0);
  EXPECT_NEAR(std::sqrt(flow_squares / n), 1e-6, 2e-8);
  EXPECT_NEAR(mixed / n, 0.0, 4.0 * 50e-6 / std::sqrt(n));
  EXPECT_NEAR(static_cast<double>(beyond_two) / n, 0.0455, 0.006);  // as a normal distribution's
  sensor.Reset();
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(sensor.Update(At(0.001 * i, -3e4)).absolute_pressure,
              first[static_cast<std::size_t>(i)]);
  }
}

TEST(VacuumSensor, RoundsAndCutsToItsRange) {
  VacuumSensorParameters parameters = Perfect();
  parameters.pressure_resolution = 250.0;
  parameters.range_min = 2e4;
  parameters.range_max = 1.05e5;
  VacuumSensor sensor(parameters);
  double time = 0.0;
  const auto read = [&](double p_abs) {
    return sensor.Update(At(time += 0.001, p_abs - kAmbient)).absolute_pressure;
  };
  EXPECT_EQ(read(50120.0), 50000.0);
  EXPECT_EQ(read(50130.0), 50250.0);
  EXPECT_EQ(read(1e4), 2e4);
  EXPECT_EQ(read(1.2e5), 1.05e5);
}

TEST(VacuumSensor, PowerIsTheDepthOfTheVacuum) {
  VacuumSensor sensor(Perfect());
  EXPECT_NEAR(sensor.Update(At(0.0, -0.6 * kAmbient)).actual_power, 0.6, 1e-12);
  EXPECT_EQ(sensor.Update(At(0.001, 0.1 * kAmbient)).actual_power, 0.0);
}

TEST(VacuumSensor, VerdictsHaveHysteresis) {
  VacuumSensorParameters parameters = Perfect();
  parameters.part_present_level = -2e4;
  parameters.part_detached_level = -1e4;
  parameters.hysteresis = 2e3;
  VacuumSensor sensor(parameters);
  double time = 0.0;
  const auto verdicts = [&](double gauge, double setpoint = -6e4) {
    const VacuumReading& r = sensor.Update(At(time += 0.001, gauge, setpoint));
    return std::string(r.in_control_range ? "C" : "-") + (r.part_present ? "P" : "-") +
           (r.part_detached ? "D" : "-");
  };
  EXPECT_EQ(verdicts(0.0), "---");  // nothing gripped yet: nothing detached
  EXPECT_EQ(verdicts(-19.9e3), "---");
  EXPECT_EQ(verdicts(-20.1e3), "-P-");
  EXPECT_EQ(verdicts(-18.1e3), "-P-");
  EXPECT_EQ(verdicts(-17.9e3), "---");
  EXPECT_EQ(verdicts(-19.9e3), "---");
  EXPECT_EQ(verdicts(-59.9e3), "-P-");
  EXPECT_EQ(verdicts(-60.0e3), "CP-");
  EXPECT_EQ(verdicts(-58.1e3), "CP-");
  EXPECT_EQ(verdicts(-57.9e3), "-P-");
  EXPECT_EQ(verdicts(-59.9e3), "-P-");
  EXPECT_EQ(verdicts(-61.0e3), "CP-");
  EXPECT_EQ(verdicts(-61.0e3, 0.0), "-P-");  // off: nothing to control
  EXPECT_EQ(verdicts(-10.1e3, 0.0), "---");
  EXPECT_EQ(verdicts(-9.9e3, 0.0), "--D");
  EXPECT_EQ(verdicts(-11.9e3), "--D");
  EXPECT_EQ(verdicts(-12.1e3), "---");
  EXPECT_EQ(verdicts(-9.9e3), "--D");
}

TEST(VacuumSensor, SwitchingOffWithoutAPartDetaches) {
  VacuumSensor sensor(Perfect());
  EXPECT_FALSE(sensor.Update(At(0.0, -500.0)).part_detached);
  EXPECT_TRUE(sensor.Update(At(0.001, -500.0, 0.0)).part_detached);
}

TEST(VacuumSensor, HysteresisLeavesASmallSetpointHalf) {
  VacuumSensorParameters parameters = Perfect();
  parameters.hysteresis = 2000.0;
  VacuumSensor sensor(parameters);
  EXPECT_TRUE(sensor.Update(At(0.0, -1000.0, -1000.0)).in_control_range);
  EXPECT_TRUE(sensor.Update(At(0.001, -501.0, -1000.0)).in_control_range);
  EXPECT_FALSE(sensor.Update(At(0.002, -499.0, -1000.0)).in_control_range);
}

TEST(VacuumSensor, VerdictsWaitForTheHoldTimeOnBothEdges) {
  VacuumSensorParameters parameters = Perfect();
  parameters.hold_time = 0.02;
  VacuumSensor sensor(parameters);
  int i = 0;
  const auto run = [&](double gauge, int samples) {
    for (int k = 0; k < samples; ++k) sensor.Update(At(0.001 * i++, gauge));
    return sensor.reading();
  };
  run(0.0, 5);
  EXPECT_FALSE(run(-6.1e4, 20).in_control_range);  // 19 ms since the first of them
  EXPECT_TRUE(run(-6.1e4, 1).in_control_range);
  EXPECT_TRUE(sensor.reading().part_present);
  EXPECT_TRUE(run(0.0, 20).in_control_range);
  EXPECT_TRUE(run(-6.1e4, 1).part_present);  // a dip shorter than that does not show
  EXPECT_TRUE(run(0.0, 20).part_present);    // and the time counts anew
  EXPECT_FALSE(sensor.reading().part_detached);
  const VacuumReading lost = run(0.0, 1);
  EXPECT_FALSE(lost.in_control_range || lost.part_present);
  EXPECT_TRUE(lost.part_detached);
}

TEST(VacuumSensor, StuckKeepsItsLastReadingUntilCleared) {
  VacuumSensor sensor(Perfect());
  sensor.Update(At(0.0, -5e4));
  sensor.SetStuck(true);
  for (int i = 1; i < 10; ++i) {
    const VacuumReading& reading = sensor.Update(At(0.001 * i, 0.0));
    EXPECT_EQ(reading.absolute_pressure, kAmbient - 5e4);
    EXPECT_EQ(reading.time, 0.0);
    EXPECT_TRUE(reading.part_present);
    EXPECT_FALSE(reading.is_new);
  }
  sensor.SetStuck(false);
  const VacuumReading& reading = sensor.Update(At(0.01, 0.0));
  EXPECT_EQ(reading.absolute_pressure, kAmbient);
  EXPECT_TRUE(reading.is_new && reading.part_detached);
}

TEST(VacuumSensorParameters, EachFieldIsNamedWithValueAndRule) {
  EXPECT_NO_THROW(Validate(VacuumSensorParameters{}));
  struct Field {
    std::string name;
    double VacuumSensorParameters::*member;
    std::vector<double> bad;
  };
  using P = VacuumSensorParameters;
  const Field fields[] = {
      {"rate", &P::rate, {0.0, -1.0, kNan}},
      {"delay", &P::delay, {-1e-3, kNan}},
      {"pressure_noise", &P::pressure_noise, {-1.0, kNan}},
      {"flow_noise", &P::flow_noise, {-1.0, kNan}},
      {"pressure_resolution", &P::pressure_resolution, {-1.0, kNan}},
      {"range_min", &P::range_min, {-1.0, kNan}},
      {"range_max", &P::range_max, {0.0, kNan}},
      {"part_present_level", &P::part_present_level, {0.0, 1.0, kNan}},
      {"part_detached_level", &P::part_detached_level, {0.0, -4000.0, kNan}},
      {"hysteresis", &P::hysteresis, {-1.0, 2001.0, kNan}},
      {"hold_time", &P::hold_time, {-1e-3, kNan}},
  };
  for (const Field& field : fields) {
    for (const double bad : field.bad) {
      VacuumSensorParameters parameters;
      parameters.*field.member = bad;
      try {
        Validate(parameters);
        ADD_FAILURE() << field.name << " = " << bad << " passed";
      } catch (const std::invalid_argument& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.find("vacuum.sensor." + field.name + " = "), 0u) << text;
        EXPECT_NE(text.find("must be"), std::string::npos) << text;
      }
    }
  }
}

}  // namespace
}  // namespace vacuum_gripper_sim
