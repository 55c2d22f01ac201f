#include "vacuum_state_publisher.h"

#include <algorithm>

#include "messages.h"
#include "vacuum_gripper_sim/config/sensor_writer.h"

namespace vacuum_gripper_sim {

VacuumStatePublisher::VacuumStatePublisher(ros::NodeHandle private_nh,
                                           const VacuumSensorParameters& parameters,
                                           double ambient_pressure, const std::string& cup_frame)
    : sensor_(parameters, ambient_pressure),
      period_(1.0 / parameters.rate),
      ambient_pressure_(ambient_pressure),
      frame_(cup_frame) {
  constexpr bool kLatched = true;
  publisher_ = private_nh.advertise<VacuumState>("vacuum_state", kQueueSize, kLatched);
}

void VacuumStatePublisher::OnStep(const ros::Time& stamp, const StepResult& result, bool stuck) {
  sensor_.SetStuck(stuck);
  const VacuumReading& reading = sensor_.Update(ToMeasure(result, ambient_pressure_));
  // A stuck one does not know that its reading is old.
  const bool repeats = stuck && result.time - last_time_ > period_ - 1e-9;
  if (!reading.is_new && !repeats) return;
  last_time_ = result.time;
  const double age = repeats ? 0.0 : result.time - reading.time;
  const ros::Time sampled = stamp - ros::Duration(std::clamp(age, 0.0, stamp.toSec()));
  publisher_.publish(ToVacuumState(reading, ambient_pressure_, MakeHeader(sampled, frame_)));
}

}  // namespace vacuum_gripper_sim
