#include "vacuum_gripper_sim/core/vacuum_sensor.h"

#include <algorithm>
#include <cmath>

#include "require.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kNow = 1e-9;  // s; times that are the same but for round-off

}  // namespace

void Validate(const VacuumSensorParameters& p) {
  RequirePositive("vacuum.sensor.rate", p.rate, "[Hz]");
  RequireNotNegative("vacuum.sensor.delay", p.delay, "[s]");
  RequireNotNegative("vacuum.sensor.pressure_noise", p.pressure_noise, "[Pa]");
  RequireNotNegative("vacuum.sensor.flow_noise", p.flow_noise, "[m^3/s]");
  RequireNotNegative("vacuum.sensor.pressure_resolution", p.pressure_resolution, "[Pa]");
  RequireNotNegative("vacuum.sensor.range_min", p.range_min, "[Pa]");
  Require(std::isfinite(p.range_max) && p.range_max > p.range_min, "vacuum.sensor.range_max",
          p.range_max, "finite and > vacuum.sensor.range_min [Pa]");
  Require(std::isfinite(p.part_present_level) && p.part_present_level < 0.0,
          "vacuum.sensor.part_present_level", p.part_present_level, "finite and < 0 [Pa]");
  Require(p.part_detached_level < 0.0 && p.part_detached_level > p.part_present_level,
          "vacuum.sensor.part_detached_level", p.part_detached_level,
          "in (vacuum.sensor.part_present_level, 0) [Pa]");
  Require(p.hysteresis >= 0.0 && p.hysteresis <= p.part_detached_level - p.part_present_level,
          "vacuum.sensor.hysteresis", p.hysteresis,
          "in [0, vacuum.sensor.part_detached_level - part_present_level] [Pa]");
  RequireNotNegative("vacuum.sensor.hold_time", p.hold_time, "[s]");
}

bool HeldCondition::Update(bool condition, double time, double hold_time) {
  if (condition == value_) {
    differs_since_.reset();
    return value_;
  }
  if (!differs_since_) differs_since_ = time;
  if (time - *differs_since_ >= hold_time - kNow) {
    value_ = condition;
    differs_since_.reset();
  }
  return value_;
}

VacuumSensor::VacuumSensor(const VacuumSensorParameters& parameters, double ambient_pressure)
    : parameters_(parameters), ambient_pressure_(ambient_pressure) {
  Reset();
}

void VacuumSensor::Reset() {
  random_.seed(parameters_.seed);
  first_time_.reset();
  num_samples_ = 0;
  in_control_range_ = part_present_ = part_detached_ = HeldCondition();
  may_detach_ = was_on_ = false;
  pending_.clear();
  reading_ = VacuumReading();
  reading_.absolute_pressure = ambient_pressure_;
}

double VacuumSensor::StandardNormal() {
  // Marsaglia's polar method, since std::normal_distribution differs from library to library; its
  // second number is left unused so that every call draws by itself.
  const auto uniform = [this]() {  // in [-1, 1)
    return static_cast<double>(random_() >> 11) * 0x1p-52 - 1.0;
  };
  for (;;) {
    const double u = uniform();
    const double v = uniform();
    const double s = u * u + v * v;
    if (s > 0.0 && s < 1.0) return u * std::sqrt(-2.0 * std::log(s) / s);
  }
}

VacuumReading VacuumSensor::Sample(const VacuumTruth& truth) {
  const VacuumSensorParameters& p = parameters_;
  VacuumReading sample;
  sample.time = truth.time;
  double pressure = truth.absolute_pressure + p.pressure_noise * StandardNormal();
  if (p.pressure_resolution > 0.0) {
    pressure = p.pressure_resolution * std::round(pressure / p.pressure_resolution);
  }
  sample.absolute_pressure = std::clamp(pressure, p.range_min, p.range_max);
  sample.flow = truth.flow + p.flow_noise * StandardNormal();

  // A level moves by the hysteresis once its condition holds.
  const double gauge = sample.absolute_pressure - ambient_pressure_;
  const double control_margin =
      in_control_range_.value() ? std::min(p.hysteresis, -0.5 * truth.setpoint) : 0.0;
  const bool in_range = truth.on && gauge <= truth.setpoint + control_margin;
  sample.in_control_range = in_control_range_.Update(in_range, truth.time, p.hold_time);

  const double present_margin = part_present_.value() ? p.hysteresis : 0.0;
  const bool present = gauge <= p.part_present_level + present_margin;
  sample.part_present = part_present_.Update(present, truth.time, p.hold_time);

  const bool switched_off = was_on_ && !truth.on;
  was_on_ = truth.on;
  may_detach_ = may_detach_ || sample.part_present || switched_off;
  const double detached_margin = part_detached_.value() ? p.hysteresis : 0.0;
  const bool detached = may_detach_ && gauge > p.part_detached_level - detached_margin;
  sample.part_detached = part_detached_.Update(detached, truth.time, p.hold_time);

  sample.actual_power = std::clamp(-gauge / ambient_pressure_, 0.0, 1.0);
  return sample;
}

const VacuumReading& VacuumSensor::Update(const VacuumTruth& truth) {
  if (!first_time_) first_time_ = truth.time;
  // A clock of its own: samples keep their mean rate at any step length.
  const double due = *first_time_ + static_cast<double>(num_samples_) / parameters_.rate;
  if (truth.time >= due - kNow) {
    pending_.push_back(Sample(truth));
    const double elapsed = (truth.time - *first_time_ + kNow) * parameters_.rate;
    num_samples_ = static_cast<std::int64_t>(std::floor(elapsed)) + 1;
  }
  reading_.is_new = false;
  while (!pending_.empty() && truth.time - pending_.front().time >= parameters_.delay - kNow) {
    if (!stuck_) {
      reading_ = pending_.front();
      reading_.is_new = true;
    }
    pending_.pop_front();
  }
  return reading_;
}

}  // namespace vacuum_gripper_sim
