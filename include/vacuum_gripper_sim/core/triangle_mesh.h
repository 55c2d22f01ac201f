#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/box_tree.h"
#include "vacuum_gripper_sim/core/triangle_geometry.h"

namespace vacuum_gripper_sim {

/// The point of a mesh that is nearest to another one, p.
struct MeshPoint {
  int triangle{0};
  Eigen::Vector3d weights;   ///< Barycentric, on that triangle.
  double distance{0.0};      ///< From p, signed by the winding: negative behind the triangle. [m]
  Eigen::Vector3d normal;    ///< Unit gradient of that distance.
  Eigen::Vector3d rim;       ///< Past a border: unit vector out of the sheet, along it; else zero.
  double rim_distance{0.0};  ///< Of p past the border, along it. [m] >= 0

  /// Of p above the sheet as it would go on past its border. [m]
  double rim_height() const;
};

/** An immutable surface of triangles with signed distances to it.

 Made of whatever a file holds: see RepairTriangles(). What encloses a volume (a closed shell) is a
 solid; the sign is then that of the angle-weighted pseudonormal (Pseudonormal()), exact for every
 point. What does not is a sheet of no thickness with two sides, of which the winding tells front
 from back; which of them is outside depends on where a point has been, see SurfaceSighting. A solid
 with a hole is a sheet, too: it holds from outside as well as from inside, except through the hole.

 Cost: RepairTriangles() and the tree are O(n log n), 0.2 s for 100 000 triangles; a query is
 O(log n) near the surface. */
class TriangleMesh {
 public:
  /** @param name      For messages: the file.
      @param vertices  3 by #V. [m]
      @param triangles 3 by #F, indices from 0.
      @throws std::invalid_argument naming the mesh, the vertex or triangle and the reason: not
        finite, an unknown vertex, no triangle of any area. */
  TriangleMesh(std::string name, const Eigen::Matrix3Xd& vertices,
               const Eigen::Matrix3Xi& triangles);

  const std::string& name() const { return name_; }
  const Eigen::Matrix3Xd& vertices() const { return vertices_; }    ///< Merged. [m]
  const Eigen::Matrix3Xi& triangles() const { return triangles_; }  ///< Mended.
  const TriangleTopology& topology() const { return topology_; }
  int num_triangles() const { return static_cast<int>(triangles_.cols()); }
  /// Unit normal by the winding; zero of a triangle without area.
  Eigen::Vector3d normal(int triangle) const { return normals_.col(triangle); }
  const Eigen::AlignedBox3d& bounds() const { return tree_.bounds(); }

  bool closed() const;  ///< Are all shells?
  int num_shells() const { return static_cast<int>(shell_closed_.size()); }
  int shell(int triangle) const { return shell_[static_cast<std::size_t>(triangle)]; }
  bool shell_closed(int shell) const { return shell_closed_[static_cast<std::size_t>(shell)]; }
  int merged_vertices() const { return merged_vertices_; }
  int dropped_triangles() const { return dropped_triangles_; }
  int turned_triangles() const { return turned_triangles_; }

  static constexpr int kNoHint = -1;
  /// A point past a border that is less than this behind the sheet is level with it. [m]
  static constexpr double kBorderTolerance = 1e-4;

  /** The nearest point to p.
   @param max_distance Nothing farther is looked for. [m]
   @param hint A triangle that may be near, as the last answer's: the search is shorter, its result
     the same.
   @returns nothing if the mesh is farther than max_distance. */
  std::optional<MeshPoint> Nearest(const Eigen::Vector3d& p,
                                   double max_distance = std::numeric_limits<double>::infinity(),
                                   int hint = kNoHint) const;

  /** What a point sees that belongs to one side of a sheet: positive on that side and past its
   borders. Of a closed shell, the point itself.
   @param side -1: the back; else the front. @param point A result of Nearest(). */
  MeshPoint SeenFrom(int side, const MeshPoint& point) const;

 private:
  TrianglePoint NearestOn(int triangle, const Eigen::Vector3d& p) const;
  MeshPoint Describe(int triangle, const TrianglePoint& at, const Eigen::Vector3d& p) const;
  void AddRim(const Eigen::Vector3d& way, const Eigen::Vector3d& pseudonormal,
              MeshPoint* point) const;

  std::string name_;
  Eigen::Matrix3Xd vertices_;
  Eigen::Matrix3Xi triangles_;
  std::vector<int> shell_;          // of each triangle
  std::vector<bool> shell_closed_;  // of each shell
  int merged_vertices_{0}, dropped_triangles_{0}, turned_triangles_{0};

  TriangleTopology topology_;
  Eigen::Matrix3Xd normals_;                          // of the triangles
  Eigen::Matrix3Xd vertex_normals_;                   // pseudonormals
  std::vector<bool> on_border_;                       // of each vertex
  std::vector<int> solid_triangles_;                  // those with an area: the tree's primitives
  Eigen::Matrix<double, 9, Eigen::Dynamic> corners_;  // of those, side by side for the search
  BoxTree tree_;
};

}  // namespace vacuum_gripper_sim
