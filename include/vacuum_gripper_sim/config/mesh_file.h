#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "vacuum_gripper_sim/core/rigid_surface.h"
#include "vacuum_gripper_sim/core/triangle_mesh.h"

namespace vacuum_gripper_sim {

/** Reads triangle meshes from files, each only once.

 Formats: STL (ASCII and binary), OBJ and DAE, by assimp. Polygons become triangles; lines and
 points are left out. DAE: nodes are placed as the file says and lengths are turned into metres by
 its `unit`, but its `up_axis` turns nothing, as in rviz; STL and OBJ say nothing of either, a
 number is a metre. */
class MeshFiles {
 public:
  /// @param base_directory Where relative paths start; empty: they are refused.
  explicit MeshFiles(std::string base_directory = "") : base_(std::move(base_directory)) {}

  /** @param field Names what holds the URI, for messages.
      @param uri   `package://name/path`, `file:///path` or a plain path.
      @param scale Of the file's x, y, z, before the shape is placed; negative ones mirror.
      @throws std::invalid_argument with one line that names field and URI: an unknown scheme or
        package, no such file, another format, unreadable, no triangles, a vertex that is not
     finite, a scale of zero, or wider than 10 m (millimetres taken for metres). */
  Mesh Load(const std::string& field, const std::string& uri, const Eigen::Vector3d& scale);

 private:
  std::string base_;
  std::map<std::tuple<std::string, double, double, double>, Mesh> loaded_;  // by path and scale
};

}  // namespace vacuum_gripper_sim
