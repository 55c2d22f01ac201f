#include "world.h"

#include <ros/console.h>
#include <tf2/exceptions.h>

#include <cstddef>
#include <utility>

#include "actuator.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kGrace = 1.0;  // For a frame that is not there, before it is worth a warning. [s]

}  // namespace

World::World(const std::string& scene_description, const std::string& world_frame,
             const SurfaceDefaults& defaults)
    : world_frame_(world_frame) {
  std::vector<SceneLink> links;
  if (scene_description.empty()) {
    RigidSurface plane{"plane", Plane{}};
    plane.friction = defaults.friction;
    plane.roughness = defaults.roughness;
    SceneLink ground;
    ground.object = FixedObject(std::move(plane));
    ground.object.name = world_frame;
    links.push_back(std::move(ground));
  } else {
    links = ReadSceneLinks(scene_description, "", defaults);
  }
  for (SceneLink& link : links) {
    PlacedLink placed;
    placed.link = std::move(link);
    links_.push_back(std::move(placed));
  }
}

std::vector<std::string> World::names() const {
  std::vector<std::string> names;
  names.reserve(links_.size());
  for (const PlacedLink& placed : links_) names.push_back(placed.link.object.name);
  return names;
}

void World::Update(const tf2_ros::Buffer& tf, Simulator* simulator) {
  std::vector<bool> were_known;
  for (const PlacedLink& placed : links_) were_known.push_back(placed.known);
  bool all_fixed_known = true;
  for (PlacedLink& placed : links_) {
    if (placed.is_free()) continue;
    placed.known = LookUp(tf, &placed);
    all_fixed_known = all_fixed_known && placed.known;
  }
  for (PlacedLink& placed : links_) {
    // Of a known one tf has what this node said. A new one would fall past what is not there yet.
    if (placed.is_free() && !placed.known && all_fixed_known) placed.known = LookUp(tf, &placed);
  }
  bool link_is_new = false;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    link_is_new = link_is_new || links_[i].known != were_known[i];
  }
  if (link_is_new) {
    SetObjects(were_known, simulator);
    return;
  }
  int index = 0;
  for (const PlacedLink& placed : links_) {
    if (!placed.known) continue;
    if (!placed.is_free()) simulator->SetObjectPose(index, placed.link.object.X_WO);
    ++index;
  }
}

void World::Reset(Simulator* simulator) const {
  int index = 0;
  for (const PlacedLink& placed : links_) {
    if (!placed.known) continue;
    if (placed.is_free()) simulator->SetObjectPose(index, placed.link.object.X_WO);
    ++index;
  }
}

/// @param were_known Links that the simulator has: of them, free ones move on as they do.
void World::SetObjects(const std::vector<bool>& were_known, Simulator* simulator) const {
  std::vector<RigidObject> objects;
  std::size_t index_before = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (!links_[i].known) continue;
    objects.push_back(links_[i].link.object);
    if (!were_known[i]) continue;
    if (links_[i].is_free()) {
      const ObjectResult& now = simulator->result().objects.at(index_before);
      objects.back().X_WO = now.X_WO;
      objects.back().velocity_W = now.velocity_W;
      objects.back().angular_velocity_W = now.angular_velocity_W;
    }
    ++index_before;
  }
  simulator->SetObjects(std::move(objects));
}

Eigen::Isometry3d World::FindPose(const tf2_ros::Buffer& tf, const PlacedLink& placed) {
  const std::string& frame = placed.link.object.name;
  if (placed.is_free() && frame != world_frame_ &&
      !tf.canTransform(world_frame_, frame, ros::Time(0))) {
    return LookUpFrame(placed.link.parent, world_frame_, tf, nullptr) * placed.link.X_PO;
  }
  ros::Time stamp;
  const Eigen::Isometry3d X_WO = LookUpFrame(frame, world_frame_, tf, &stamp);
  if (placed.is_free()) {
    ROS_WARN("tf has free link '%s' already: it begins there; whoever broadcasts it must stop now",
             frame.c_str());
  } else if (IsStale(stamp) && throttle_.Pass("stale " + frame)) {
    ROS_WARN("tf has not updated scene link '%s' for a while: it stays where it was last seen",
             frame.c_str());
  }
  return X_WO;
}

bool World::LookUp(const tf2_ros::Buffer& tf, PlacedLink* placed) {
  try {
    placed->link.object.X_WO = FindPose(tf, *placed);
    placed->missing = ros::WallTime();
    return true;
  } catch (const tf2::TransformException& error) {
    const std::string& frame = placed->link.object.name;
    const ros::WallTime now = ros::WallTime::now();
    if (placed->missing.isZero()) placed->missing = now;
    // tf needs a moment to hear of its frames when everything is launched at once.
    if ((now - placed->missing).toSec() > kGrace && throttle_.Pass(frame)) {
      ROS_WARN("tf cannot place scene link '%s' in '%s' (%s): it %s", frame.c_str(),
               world_frame_.c_str(), error.what(),
               placed->known ? "stays where it was last seen"
                             : "is left out until tf can, and so are free links");
    }
    return placed->known;
  }
}

}  // namespace vacuum_gripper_sim
