#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_surface.h"
#include "vacuum_gripper_sim/core/surface_sighting.h"

namespace vacuum_gripper_sim {

/// One row of H_c: a node that may not pass a surface.
struct NodeContact {
  int node{0};             ///< Mesh node.
  int surface{0};          ///< Index of the rigid surface.
  double gap{0.0};         ///< Signed distance; < 0: penetrating. [m]
  Eigen::Vector3d normal;  ///< Out of the surface, world axes: d(gap)/dx.
};

/// Distances of `nodes` to the surface nearest to each; +inf without surfaces. [m]
/// @param x_W Positions of all mesh nodes, 3 by #nodes. [m]
std::vector<double> NearestDistances(const std::vector<RigidSurface>& surfaces,
                                     const std::vector<int>& nodes, const Eigen::Matrix3Xd& x_W);

/** The narrow phase of a step: what its nodes saw of the surfaces when it began.

 A motion may end far inside a solid, or behind a thin one: without its contacts, the free motion
 often does. Its gap is therefore measured along the side of the solid on which the node started,

     gap(x1) = d(x0) + n(x0) . (x1 - x0),

 which is exact for planes and faces; curved surfaces are measured anew near their contact. What a
 node sees of a triangle mesh is remembered from step to step, see SurfaceSighting. */
class NarrowPhase {
 public:
  /// @param surfaces Must outlive this. @param nodes Mesh nodes to watch, ascending.
  /// @param x0_W Positions at the step's start, 3 by #nodes. [m]
  void Begin(const std::vector<RigidSurface>& surfaces, const std::vector<int>& nodes,
             const Eigen::Matrix3Xd& x0_W);

  /// Forgets what nodes saw before, as when they or the surfaces are other ones.
  void Forget() { sightings_.clear(); }

  /// The pairs, with their gap at x1, of which `wanted` is true. Nodes ascending.
  template <typename Predicate>
  std::vector<NodeContact> Select(const Eigen::Matrix3Xd& x1_W, const Predicate& wanted) const {
    std::vector<NodeContact> contacts;
    for (int i = 0; i < num_pairs(); ++i) {
      const NodeContact contact = Ahead(i, x1_W);
      if (wanted(contact)) contacts.push_back(contact);
    }
    return contacts;
  }

  /// Pairs are numbered by node, then by surface.
  int num_pairs() const { return static_cast<int>(seen_.size()); }
  int node(int pair) const { return nodes_[static_cast<std::size_t>(pair) / surfaces_->size()]; }
  int surface(int pair) const { return pair % static_cast<int>(surfaces_->size()); }
  /// From the start; of a mesh that is farther away than 10 mm a lower bound.
  const SurfaceDistance& seen(int pair) const { return seen_[static_cast<std::size_t>(pair)]; }
  /// The pair with its gap at x1, seen from its start.
  NodeContact Ahead(int pair, const Eigen::Matrix3Xd& x1_W) const;
  /// The pair measured at x1. @param surfaces Where they are then.
  NodeContact At(int pair, const std::vector<RigidSurface>& surfaces, const Eigen::Matrix3Xd& x1_W);
  /// The surface that is nearest to a node at the start. @pre There is one.
  int NearestSurface(int node) const;
  /// Of each watched node at x1 to the surface nearest to it; +inf without surfaces. [m]
  void Nearest(const std::vector<RigidSurface>& surfaces, const Eigen::Matrix3Xd& x1_W,
               std::vector<double>* nearest);

 private:
  SurfaceDistance Look(std::size_t pair, const RigidSurface& surface, const Eigen::Vector3d& p_W);

  const std::vector<RigidSurface>* surfaces_{nullptr};
  std::vector<int> nodes_;
  Eigen::Matrix3Xd x0_W_;
  std::vector<SurfaceDistance> seen_;
  std::vector<SurfaceSighting> sightings_;  // by pair, if any surface is a mesh
};

}  // namespace vacuum_gripper_sim
