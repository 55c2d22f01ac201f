#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace vacuum_gripper_sim {

/// Half space z <= 0 of its own frame S; its surface is the plane z = 0.
struct Plane {};

/// Box centred in S, edges along its axes.
struct Box {
  Eigen::Vector3d size{Eigen::Vector3d::Zero()};  ///< Full edge lengths. [m]
};

/// Sphere centred in S.
struct Sphere {
  double radius{0.0};  ///< [m]
};

/// Solid cylinder centred in S, axis along z (as in URDF).
struct Cylinder {
  double radius{0.0};  ///< [m]
  double length{0.0};  ///< [m]
};

/// Triangles in S, shared by all surfaces that show them: a solid or, if open, a sheet.
class TriangleMesh;
using Mesh = std::shared_ptr<const TriangleMesh>;

using Shape = std::variant<Plane, Box, Sphere, Cylinder, Mesh>;

/// A hole through a surface, too small to be part of its shape.
struct SurfaceHole {
  Eigen::Vector3d p_S{Eigen::Vector3d::Zero()};  ///< Where, in S. [m]
  double area{0.0};                              ///< Effective orifice. [m^2] >= 0
};

/// A rigid surface in a frame F: that of the object it is fixed to, or the world where it is
/// placed.
struct RigidSurface {
  std::string name;  ///< For messages: the URDF link or the scenario's key.
  Shape shape;
  Eigen::Isometry3d X_FS{Eigen::Isometry3d::Identity()};  ///< Pose of S in F.
  double friction{0.0};                                   ///< Coulomb's mu. [-] >= 0
  // What air finds, where the gripper's source flows.
  double roughness{0.0};             ///< h_rms of its heights, see HydraulicGap(). [m] >= 0
  double permeance{0.0};             ///< k / (mu L) of a porous wall, 0: tight. [m/(Pa s)] >= 0
  std::vector<SurfaceHole> holes{};  ///< Through it.
};

/// What a point sees of a surface.
struct SurfaceDistance {
  double distance{0.0};    ///< Signed; negative inside the solid. [m]
  Eigen::Vector3d normal;  ///< Unit gradient of the distance: out of the solid, axes of F.
};

/** Signed distance of a point to a surface and the direction out of it.

 Exact inside and outside. Where the nearest point is not unique (a sphere's centre, a box's middle)
 one of the directions is returned, always a unit vector. Of an open mesh the side from which its
 triangles are counter-clockwise is outside; see SurfaceSighting for the other one.

 @param p_F The point. [m] */
SurfaceDistance Distance(const RigidSurface& surface, const Eigen::Vector3d& p_F);

/// The same in the shape's own frame S, normal included.
SurfaceDistance Distance(const Shape& shape, const Eigen::Vector3d& p_S);

/// Is X finite and its linear part a rotation (within 1e-6)?
bool IsRigidMotion(const Eigen::Isometry3d& X);

/** Checks a surface's numbers.
 @throws std::invalid_argument naming the surface, the field, its value and what is allowed: sizes
   finite and > 0, a mesh there, friction, roughness, permeance and the holes' areas finite and
   >= 0, the holes' places finite, the pose finite and a rotation. */
void Validate(const RigidSurface& surface);

}  // namespace vacuum_gripper_sim
