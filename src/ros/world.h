#pragma once

#include <tf2_ros/buffer.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "throttle.h"
#include "vacuum_gripper_sim/config/scene_urdf.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {

/** The rigid objects around the cup: fixed ones kept where tf says they are, free ones put where
 they begin and left to the simulation.

 A free link begins where tf has its frame, else at its joint's origin in the frame of the link
 above it. From then on this node says where it is, and tf is not asked again.

 A link that tf does not know yet is not in the world; it enters when tf knows it. A link that tf
 loses stays where it was last seen. Both are said in throttled warnings. */
class World {
 public:
  /** @param scene_description URDF; empty: a plane at z = 0 of the world frame.
      @param defaults Of surfaces that do not say.
      @throws std::invalid_argument, see ReadSceneLinks(). */
  World(const std::string& scene_description, const std::string& world_frame,
        const SurfaceDefaults& defaults);

  /// Names of all links with something to touch, whether tf knows them or not.
  std::vector<std::string> names() const;

  /// Looks the links up, lets new ones in and moves the fixed ones in the simulator.
  void Update(const tf2_ros::Buffer& tf, Simulator* simulator);
  /// Puts free objects back where they began, at rest.
  void Reset(Simulator* simulator) const;

 private:
  struct PlacedLink {
    SceneLink link;         // object.X_WO: where tf has it, or had it last; of a free one,
                            // where it began
    bool known{false};      // Has tf ever placed it?
    ros::WallTime missing;  // Since when it has not been found; zero: it has.

    bool is_free() const { return link.object.inertia.has_value(); }
  };

  // Where tf has the link now; its last pose if tf has lost it. False if tf never knew it.
  bool LookUp(const tf2_ros::Buffer& tf, PlacedLink* placed);
  // Where a link begins or is. Throws tf2::TransformException if tf does not know.
  Eigen::Isometry3d FindPose(const tf2_ros::Buffer& tf, const PlacedLink& placed);
  void SetObjects(const std::vector<bool>& were_known, Simulator* simulator) const;

  std::string world_frame_;
  std::vector<PlacedLink> links_;
  Throttle throttle_;
};

}  // namespace vacuum_gripper_sim
