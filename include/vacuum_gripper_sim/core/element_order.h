#pragma once

#include <vector>

#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// Elements in order of their distance, in steps from neighbour to neighbour, from one at an end of
/// the mesh: ranges of it have few nodes in common with the others.
std::vector<int> OrderByNeighbours(const TetMesh& mesh);

}  // namespace vacuum_gripper_sim
