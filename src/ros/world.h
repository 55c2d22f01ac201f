#pragma once

#include <tf2_ros/buffer.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "throttle.h"
#include "vacuum_gripper_sim/config/scene_urdf.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {

/** The rigid objects around the cup, kept where tf says they are.

 A link that tf does not know yet is not in the world; it enters when tf knows it. A link that tf
 loses stays where it was last seen. Both are said in throttled warnings. */
class World {
 public:
  /** @param scene_description URDF; empty: a plane at z = 0 of the world frame.
      @throws std::invalid_argument, see ReadSceneUrdf(). */
  World(const std::string& scene_description, const std::string& world_frame);

  /// Looks every link up and moves the simulator's objects there.
  void Update(const tf2_ros::Buffer& tf, Simulator* simulator);

 private:
  struct PlacedLink {
    RigidObject object;     // X_WO: where tf has it, or had it last
    bool known{false};      // Has tf ever placed it?
    ros::WallTime missing;  // Since when it has not been found; zero: it has.
  };

  // Where tf has the link now; its last pose if tf has lost it. False if tf never knew it.
  bool LookUp(const tf2_ros::Buffer& tf, PlacedLink* placed);

  std::string world_frame_;
  std::vector<PlacedLink> links_;
  Throttle throttle_;
};

}  // namespace vacuum_gripper_sim
