#include "world.h"

#include <ros/console.h>
#include <tf2/exceptions.h>

#include <utility>

#include "actuator.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kGrace = 1.0;  // For a frame that is not there, before it is worth a warning. [s]

}  // namespace

World::World(const std::string& scene_description, const std::string& world_frame)
    : world_frame_(world_frame) {
  std::vector<RigidObject> objects;
  if (scene_description.empty()) {
    RigidObject ground = FixedObject(RigidSurface{"plane", Plane{}});
    ground.name = world_frame;
    objects.push_back(std::move(ground));
  } else {
    objects = ReadSceneUrdf(scene_description);
  }
  for (RigidObject& object : objects) {
    PlacedLink placed;
    placed.object = std::move(object);
    links_.push_back(std::move(placed));
  }
}

void World::Update(const tf2_ros::Buffer& tf, Simulator* simulator) {
  bool link_is_new = false;
  for (PlacedLink& placed : links_) {
    const bool was_known = placed.known;
    placed.known = LookUp(tf, &placed);
    link_is_new = link_is_new || placed.known != was_known;
  }

  std::vector<RigidObject> objects;
  for (const PlacedLink& placed : links_) {
    if (!placed.known) continue;
    if (!link_is_new) {
      simulator->SetObjectPose(static_cast<int>(objects.size()), placed.object.X_WO);
    }
    objects.push_back(placed.object);
  }
  if (link_is_new) simulator->SetObjects(std::move(objects));
}

bool World::LookUp(const tf2_ros::Buffer& tf, PlacedLink* placed) {
  const std::string& frame = placed->object.name;
  try {
    ros::Time stamp;
    placed->object.X_WO = LookUpFrame(frame, world_frame_, tf, &stamp);
    placed->missing = ros::WallTime();
    if (IsStale(stamp) && throttle_.Pass("stale " + frame)) {
      ROS_WARN("tf has not updated scene link '%s' for a while: it stays where it was last seen",
               frame.c_str());
    }
    return true;
  } catch (const tf2::TransformException& error) {
    const ros::WallTime now = ros::WallTime::now();
    if (placed->missing.isZero()) placed->missing = now;
    // tf needs a moment to hear of its frames when everything is launched at once.
    if ((now - placed->missing).toSec() > kGrace && throttle_.Pass(frame)) {
      ROS_WARN("tf cannot place scene link '%s' in '%s' (%s): it %s", frame.c_str(),
               world_frame_.c_str(), error.what(),
               placed->known ? "stays where it was last seen" : "is left out until tf can");
    }
    return placed->known;
  }
}

}  // namespace vacuum_gripper_sim
