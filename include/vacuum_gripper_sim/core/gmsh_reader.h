#pragma once

#include <string>

#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/** Reads a cup from a Gmsh MSH file, format 2.2 or 4.1, ASCII, in metres.

 The file has the physical surface groups `mount` and `cavity` and one or more physical volumes of
 4-node (Gmsh type 4) or 10-node (type 11) tetrahedra, not both. Other groups and lower-dimensional
 elements are ignored; nodes that no tetrahedron uses are dropped.

 @throws std::invalid_argument with "file:line: reason" for what is wrong with the text (truncated,
   not a number, unknown version, binary, missing group) and with file and element or node for what
   is wrong with the mesh; see MakeTetMesh(). */
TetMesh ReadGmsh(const std::string& path);

}  // namespace vacuum_gripper_sim
