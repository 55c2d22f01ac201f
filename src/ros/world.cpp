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
  std::vector<SceneLink> links;
  if (scene_description.empty()) {
    links.push_back({world_frame, {{"plane", Plane{}, Eigen::Isometry3d::Identity()}}});
  } else {
    links = ReadSceneUrdf(scene_description);
  }
  for (SceneLink& link : links) {
    PlacedLink placed;
    placed.link = std::move(link);
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

  std::vector<RigidSurface> surfaces;
  int index = 0;
  for (const PlacedLink& placed : links_) {
    if (!placed.known) continue;
    for (RigidSurface surface : placed.link.surfaces) {
      surface.X_WS = placed.X_WL * surface.X_WS;
      if (!link_is_new) simulator->SetSurfacePose(index, surface.X_WS);
      surfaces.push_back(std::move(surface));
      ++index;
    }
  }
  if (link_is_new) simulator->SetSurfaces(std::move(surfaces));
}

bool World::LookUp(const tf2_ros::Buffer& tf, PlacedLink* placed) {
  const std::string& frame = placed->link.name;
  try {
    ros::Time stamp;
    placed->X_WL = LookUpFrame(frame, world_frame_, tf, &stamp);
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
