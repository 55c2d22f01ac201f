// What a sensor showed on a robot that gripped a ball and pulled: the simulated one shows the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/config/experiment.h"
#include "vacuum_gripper_sim/config/scenario.h"
#include "vacuum_gripper_sim/config/sensor_writer.h"
#include "vacuum_gripper_sim/core/vacuum_sensor.h"
#include "validation/reference_case.h"

namespace vacuum_gripper_sim {
namespace {

/// A reading, and the force with which the cup draws the wrist to the ball at that time.
struct Sample {
  double time{0.0};      // s
  double pressure{0.0};  // absolute [hPa]
  double force{0.0};     // N
};

/// The grip as the sensor shows it.
struct Sequence {
  double before_seal{0.0};  // last reading before the fall [hPa]
  double sealed{0.0};       // the one after it [hPa]
  double deepest{0.0};      // hPa
  double fall_time{0.0};    // from `sealed` to where it first is within kNear of `deepest` [s]
  double before_loss{0.0};  // last reading before the loss [hPa]
  double rise_time{0.0};    // from where it last is within kNear of `deepest` to the loss [s]
  double lost{0.0};         // first reading after the loss [hPa]
  double hold_force{0.0};   // mean from `deepest` to the beginning of the rise [N]
  double last_force{0.0};   // at before_loss [N]

  double rise() const { return before_loss - deepest; }
};

constexpr double kNear = 15.0;   // hPa
constexpr double kOpen = 940.0;  // the line reads more with the cup in the air [hPa]

/// @param samples Of a cup that was in the air, gripped and lost its grip, the ejector at work.
Sequence Read(const std::vector<Sample>& samples) {
  std::size_t seal = 1;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const auto fall = [&](std::size_t k) { return samples[k - 1].pressure - samples[k].pressure; };
    if (samples[i - 1].pressure < 1000.0 && fall(i) > fall(seal)) seal = i;
  }
  std::size_t loss = seal;
  while (loss + 1 < samples.size() && samples[loss].pressure < kOpen) ++loss;
  std::size_t deepest = seal;
  for (std::size_t i = seal; i < loss; ++i) {
    if (samples[i].pressure < samples[deepest].pressure) deepest = i;
  }
  const auto is_near = [&](const Sample& sample) {
    return sample.pressure <= samples[deepest].pressure + kNear;
  };
  std::size_t down = seal, up = loss - 1;
  while (!is_near(samples[down])) ++down;
  while (!is_near(samples[up])) --up;

  Sequence sequence;
  sequence.before_seal = samples[seal - 1].pressure;
  sequence.sealed = samples[seal].pressure;
  sequence.deepest = samples[deepest].pressure;
  sequence.fall_time = samples[down].time - samples[seal].time;
  sequence.before_loss = samples[loss - 1].pressure;
  sequence.rise_time = samples[loss - 1].time - samples[up].time;
  sequence.lost = samples[loss].pressure;
  for (std::size_t i = down; i <= up; ++i) sequence.hold_force += samples[i].force;
  sequence.hold_force /= static_cast<double>(up - down + 1);
  sequence.last_force = samples[loss - 1].force;
  return sequence;
}

void Print(const char* name, const Sequence& s) {
  std::printf(
      "%-10s %.0f -> %.0f hPa, in %.2f s to %.0f; in %.2f s to %.0f -> %.0f; %.2f N, at last "
      "%.2f\n",
      name, s.before_seal, s.sealed, s.fall_time, s.deepest, s.rise_time, s.before_loss, s.lost,
      s.hold_force, s.last_force);
}

void ExpectSequence(const Sequence& s) {
  EXPECT_GT(s.before_seal, kOpen);
  EXPECT_LT(s.sealed, 700.0);
  EXPECT_GT(s.sealed, 600.0);
  EXPECT_LT(s.deepest, s.sealed - 100.0);
  EXPECT_GT(s.fall_time, 0.1);
  EXPECT_GT(s.rise(), 200.0);
  EXPECT_GT(s.rise_time, 0.3);
  EXPECT_LT(s.rise_time, 1.2);
  EXPECT_GT(s.last_force, 0.5 * s.hold_force);
  EXPECT_GT(s.lost, 955.0);
}

std::vector<Sample> Record() {
  const ReferenceTable wrench("measured/grip_0_wrench.csv");
  // Its zero drifts; what it says with the cup in the air counts as none.
  double offset = 0.0;
  int in_the_air = 0;
  for (const ReferenceTable::Row& row : wrench.rows()) {
    if (row.at("t") > 2.8) break;
    offset += row.at("fz");
    ++in_the_air;
  }
  offset /= in_the_air;
  const ReferenceTable sensor("measured/grip_0_pressure.csv");
  std::vector<Sample> samples;
  samples.reserve(sensor.rows().size());
  std::size_t k = 0;
  for (const ReferenceTable::Row& row : sensor.rows()) {
    while (k + 1 < wrench.rows().size() && wrench.rows()[k + 1].at("t") <= row.at("t")) ++k;
    samples.push_back({row.at("t"), row.at("p_hPa"), wrench.rows()[k].at("fz") - offset});
  }
  return samples;
}

std::vector<Sample> Simulate(const std::vector<std::string>& overrides) {
  const std::string share = VACUUM_GRIPPER_SOURCE_DIR;
  const Scenario scenario =
      ReadScenario(share + "/config/experiments/measured_grip.yaml", overrides, share);
  Simulator simulator = MakeSimulator(scenario);
  const double ambient = scenario.parameters.vacuum.ambient_pressure;
  VacuumSensor sensor(scenario.sensor, ambient);
  std::vector<Sample> samples;
  const ExperimentOutcome outcome =
      RunExperiment(scenario, &simulator, [&](const StepResult& result) {
        const VacuumReading& reading = sensor.Update(ToMeasure(result, ambient));
        if (!reading.is_new) return;
        samples.push_back({reading.time, 0.01 * reading.absolute_pressure, result.force_M.z()});
      });
  EXPECT_FALSE(outcome.solver_failed()) << outcome.message;
  return samples;
}

TEST(MeasuredRecord, TheSensorShowsTheLossBeforeItComes) {
  const Sequence record = Read(Record());
  Print("measured", record);
  ExpectSequence(record);
  const Sequence simulated = Read(Simulate({}));
  Print("simulated", simulated);
  ExpectSequence(simulated);
}

TEST(MeasuredRecord, NothingFallsWhereNothingSeals) {
  const auto deepest = [](const std::vector<Sample>& samples) {
    return std::min_element(
               samples.begin(), samples.end(),
               [](const Sample& a, const Sample& b) { return a.pressure < b.pressure; })
        ->pressure;
  };
  const ReferenceTable sensor("measured/never_sealed_pressure.csv");
  std::vector<Sample> record;
  record.reserve(sensor.rows().size());
  for (const ReferenceTable::Row& row : sensor.rows()) {
    record.push_back({row.at("t"), row.at("p_hPa"), 0.0});
  }
  const double simulated = deepest(Simulate({"surfaces.0.position=[0.06, 0.0, -0.0375]"}));
  std::printf("never below %.1f hPa, measured %.1f\n", simulated, deepest(record));
  EXPECT_GT(deepest(record), 955.0);
  EXPECT_GT(simulated, 955.0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
