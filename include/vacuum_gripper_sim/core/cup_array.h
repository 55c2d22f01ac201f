#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// A gripper's equal cups as one body in pieces: node n of the single cup is node
/// k nodes_per_cup + n of cup k.
struct CupArray {
  TetMesh mesh;            ///< Of all cups, in the rest frame R.
  CavitySurface cavities;  ///< Likewise.
  std::vector<CupMount> mounts;
  Eigen::Matrix3Xd rest_M;       ///< Rest positions in the gripper's mount frame, 3 by #nodes. [m]
  Eigen::Matrix3Xd rest_of_one;  ///< Of the single cup in its own rest frame. [m]
  int nodes_per_cup{0};

  int num_cups() const { return static_cast<int>(mounts.size()); }
  int CupOfNode(int node) const { return node / nodes_per_cup; }
  int FirstNode(std::size_t cup) const { return static_cast<int>(cup) * nodes_per_cup; }
};

/// @param cup A single cup at rest. @param mounts At least one.
/// @throws std::invalid_argument if the mesh's cavity is unusable.
CupArray MakeCupArray(const TetMesh& cup, std::vector<CupMount> mounts);

/// Pose of a single cup's rest frame R in its mount frame: M has its origin on the cup's axis at
/// the height of the mount's top and z along suction, out of the cup: p_M = (x, -y, z_top - z) for
/// a mesh point (x, y, z).
Eigen::Isometry3d MountFromRest(const TetMesh& cup);

/** Several equal cups on one mount as one body in pieces: nodes, elements and faces of cup k follow
 those of cup k - 1, so that node n of the single cup is node k #nodes + n.

 @param cup  The single one, at rest.
 @param X_RK Pose of each cup's rest frame K in that of the array.
 @returns a mesh of as many pieces as poses. */
TetMesh RepeatMesh(const TetMesh& cup, const std::vector<Eigen::Isometry3d>& X_RK);

/// The cavity surfaces of such a mesh. @param cavity Of the single cup. @param num_nodes Of its
/// mesh. @param count Of cups.
CavitySurface RepeatCavity(const CavitySurface& cavity, int num_nodes, int count);

/// One cup's surface alone, its nodes numbered as in the array.
CavitySurface CavityOfCup(const CavitySurface& cavities, int cup);

}  // namespace vacuum_gripper_sim
