#include <ros/ros.h>

#include <exception>

#include "vacuum_gripper_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "vacuum_gripper");
  const ros::NodeHandle private_nh("~");  // Outlives the node: without a handle nothing is logged.
  try {
    vacuum_gripper_sim::VacuumGripperNode(private_nh).Run();
  } catch (const std::exception& error) {
    ROS_FATAL("%s stops: %s", ros::this_node::getName().c_str(), error.what());
    return 1;
  }
  return 0;
}
