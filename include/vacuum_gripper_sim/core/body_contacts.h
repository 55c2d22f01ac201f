#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_surface.h"
#include "vacuum_gripper_sim/core/rigid_world.h"
#include "vacuum_gripper_sim/core/surface_sighting.h"

namespace vacuum_gripper_sim {

/** What rigid objects see of each other, at least one of two being free.

 A shape is felt out by points: a sphere by its centre and radius, a box by its corners and points
 on its edges, a cylinder by points on its rims, two of them those that are deepest in the other, a
 triangle mesh by its vertices. Each of two objects is felt out by the other, so that a box on a
 table's edge is held as well as one in the middle of it. Edges that cross between such points
 are not found. */
class BodyContacts {
 public:
  /// A point of one object before a surface of another.
  struct Pair {
    std::uint32_t id{0};   ///< The same in the next step.
    int feeling{0};        ///< The surface that has the point.
    int surface{0};        ///< What is felt.
    Eigen::Vector3d p_W;   ///< The point, or a sphere's centre, when the step begins. [m]
    double radius{0.0};    ///< Of the sphere. [m]
    SurfaceDistance seen;  ///< From there, less the radius.
  };

  /// Starts a step. @param reach Pairs of objects farther from each other are left out. [m]
  void Begin(const RigidWorld& world, double reach);

  /// Forgets on which side of a sheet a point is, as when there are other objects.
  void Forget() { sightings_.clear(); }

  /// What the point of a pair sees where a trial ends. @param surface The felt one. @param p_W The
  /// point, or the sphere's centre. @returns the radius not yet taken off. [m]
  SurfaceDistance Look(const Pair& pair, const RigidSurface& surface, const Eigen::Vector3d& p_W);

  /// With ascending ids.
  const std::vector<Pair>& pairs() const { return pairs_; }
  bool Sees(std::uint32_t id) const;
  /// @pre Sees(id).
  const Pair& Find(std::uint32_t id) const;

 private:
  std::vector<Pair> pairs_;
  std::unordered_map<std::uint32_t, SurfaceSighting> sightings_;  // of meshes, by id
};

}  // namespace vacuum_gripper_sim
