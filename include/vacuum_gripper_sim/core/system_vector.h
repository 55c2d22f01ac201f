#pragma once

#include <Eigen/Core>
#include <cmath>

namespace vacuum_gripper_sim {

/// A velocity, an impulse, or something in between, of the cup's free nodes and of the free bodies.
struct SystemVector {
  Eigen::VectorXd cup;     ///< 3 #free.
  Eigen::VectorXd bodies;  ///< 6 #bodies, see RigidWorld.

  void SetZero(Eigen::Index cup_size, Eigen::Index bodies_size) {
    cup.setZero(cup_size);
    bodies.setZero(bodies_size);
  }
  double dot(const SystemVector& other) const {
    return cup.dot(other.cup) + bodies.dot(other.bodies);
  }
  double norm() const { return std::sqrt(dot(*this)); }
  SystemVector& operator*=(double factor) {
    cup *= factor;
    bodies *= factor;
    return *this;
  }
  /// Adds factor times another.
  void Add(double factor, const SystemVector& other) {
    cup += factor * other.cup;
    bodies += factor * other.bodies;
  }
};

}  // namespace vacuum_gripper_sim
