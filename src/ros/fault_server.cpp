#include "fault_server.h"

#include <ros/console.h>

#include <stdexcept>
#include <utility>

namespace vacuum_gripper_sim {

FaultServer::FaultServer(ros::NodeHandle private_nh, const std::vector<FaultCommand>& faults,
                         FaultList list)
    : list_(std::move(list)) {
  for (std::size_t i = 0; i < faults.size(); ++i) {
    try {
      ROS_WARN("fault: %s", list_.Apply(faults[i]).c_str());
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("parameter faults." + std::to_string(i) + "." + error.what());
    }
  }
  server_ = private_nh.advertiseService("set_fault", &FaultServer::OnSetFault, this);
}

void FaultServer::Update(Simulator* simulator) {
  const std::vector<RigidObject>& objects = simulator->objects();
  if (!changed_ && objects.size() == num_objects_) return;
  simulator->SetFaults(list_.ToFaults(objects));
  num_objects_ = objects.size();
  changed_ = false;
}

bool FaultServer::OnSetFault(SetFault::Request& request, SetFault::Response& response) {
  FaultCommand command;
  command.fault = request.fault;
  command.active = request.active != 0;
  command.target = request.target;
  command.value = request.value;
  command.azimuth = request.azimuth;
  command.width = request.width;
  try {
    response.message = list_.Apply(command);
    response.success = true;
    changed_ = true;
    ROS_WARN("fault: %s", response.message.c_str());
  } catch (const std::invalid_argument& error) {
    response.message = error.what();
    response.success = false;
  }
  return true;
}

}  // namespace vacuum_gripper_sim
