#include "cup_publisher.h"

#include "messages.h"

namespace vacuum_gripper_sim {

CupPublisher::CupPublisher(ros::NodeHandle private_nh, const CupMount& cup,
                           const std::string& cup_frame)
    : frame_(cup_frame + "/" + cup.name) {
  constexpr bool kLatched = true;
  const std::string prefix = "cups/" + cup.name + "/";
  wrench_publisher_ =
      private_nh.advertise<geometry_msgs::WrenchStamped>(prefix + "wrench", kQueueSize);
  seal_publisher_ = private_nh.advertise<SealState>(prefix + "seal_state", kQueueSize, kLatched);
  pressure_publisher_ =
      private_nh.advertise<sensor_msgs::FluidPressure>(prefix + "pressure", kQueueSize);
}

void CupPublisher::PublishForces(const ros::Time& stamp, const CupResult& cup,
                                 double ambient_pressure) const {
  const std_msgs::Header header = MakeHeader(stamp, frame_);
  wrench_publisher_.publish(ToWrench(cup.force_C, cup.torque_C, header));
  pressure_publisher_.publish(ToFluidPressure(cup, ambient_pressure, header));
}

void CupPublisher::PublishState(const ros::Time& stamp, const CupResult& cup,
                                double setpoint) const {
  seal_publisher_.publish(ToSealState(cup, setpoint, MakeHeader(stamp, frame_)));
}

}  // namespace vacuum_gripper_sim
