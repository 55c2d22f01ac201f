#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "vacuum_gripper_sim/core/rigid_object.h"
#include "vacuum_gripper_sim/core/rigid_surface.h"

namespace vacuum_gripper_sim {

/** The objects around the cup, and how the free ones move.

 A free body's velocity V = (v, omega) is that of its centre of mass C and its angular velocity, in
 world axes. A step changes it by dV,

     M dV = b + h J^T lambda,   M = diag(m 1, R I_C R^T),   b = h (m g, -omega x R I_C R^T omega),

 with M taken at the step's start, and moves the body by h (V + dV): C along a line, the body about
 it along a screw. J^T lambda collects the forces on it, pressure included. */
class RigidWorld {
 public:
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  static constexpr int kNone = -1;

  /// Replaces all objects; free ones start with their velocities.
  /// @throws std::invalid_argument, see Validate(const RigidObject&).
  void SetObjects(std::vector<RigidObject> objects);
  /// Puts an object somewhere for the steps to come; a free one comes to rest there.
  /// @throws std::invalid_argument if the pose is not a rigid motion, std::out_of_range for an
  /// unknown index.
  void SetPose(int object, const Eigen::Isometry3d& X_WO);

  const std::vector<RigidObject>& objects() const { return objects_; }
  /// Of all objects, one after the other, placed in the world: X_FS is X_WS.
  const std::vector<RigidSurface>& surfaces() const { return surfaces_; }
  int ObjectOf(int surface) const { return object_of_[static_cast<std::size_t>(surface)]; }

  /// Free bodies are numbered apart. kNone: the object is not free.
  int BodyOf(int object) const { return body_of_[static_cast<std::size_t>(object)]; }
  int num_bodies() const { return static_cast<int>(bodies_.size()); }
  Vector6d velocity(int body) const;                 ///< [m/s], [rad/s]
  Eigen::Vector3d CentreOfMass(int body) const;      ///< World. [m]
  Eigen::Matrix<double, 6, 6> Mass(int body) const;  ///< M. [kg], [kg m^2]
  /// b of gravity and rotation. @param gravity [m/s^2] @param h [s] @param[out] b 6 #bodies. [N s],
  /// [N m s]
  void FreeImpulse(const Eigen::Vector3d& gravity, double h, Eigen::VectorXd* b) const;

  /// Where the surfaces are after a step. @param dV 6 #bodies. @param[out] surfaces
  void SurfacesAfter(const Eigen::VectorXd& dV, double h,
                     std::vector<RigidSurface>* surfaces) const;
  /// How far a step moves the point of an object that is at p_W when it begins (for one that is put
  /// somewhere: the point that is at p_W when it ends). [m]
  Eigen::Vector3d Displacement(int object, const Eigen::Vector3d& p_W, const Eigen::VectorXd& dV,
                               double h) const;

  /// Of that only what a step itself brings about: zero of what is not free, which is seen where it
  /// is put from the step's start. [m]
  Eigen::Vector3d FreeDisplacement(int object, const Eigen::Vector3d& p_W,
                                   const Eigen::VectorXd& dV, double h) const;

  /// Was an object put elsewhere since the last step?
  bool WasPut(int object) const;
  /// Does any object move in this step: is one free, or put elsewhere since the last one?
  bool AnyMoves() const;

  /// Ends a step: free bodies move.
  void Advance(const Eigen::VectorXd& dV, double h);

 private:
  struct Body {
    int object{0};
    Vector6d V{Vector6d::Zero()};
  };
  Eigen::Isometry3d PoseAfter(int object, const Eigen::VectorXd& dV, double h) const;
  void Place(int object, const Eigen::Isometry3d& X_WO, std::vector<RigidSurface>* surfaces) const;

  std::vector<RigidObject> objects_;
  std::vector<Eigen::Isometry3d> X_WO_before_;  // poses at the end of the last step
  std::vector<RigidSurface> surfaces_;
  std::vector<int> object_of_;      // by surface
  std::vector<int> first_surface_;  // by object
  std::vector<int> body_of_;        // by object
  std::vector<Body> bodies_;
};

}  // namespace vacuum_gripper_sim
