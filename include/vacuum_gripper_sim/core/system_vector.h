#pragma once

#include <Eigen/Core>
#include <algorithm>
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
  /// By size: how fast a node or a body moves along an axis, or what is 1 m from a body's centre as
  /// it turns. May overlook what is not a number.
  double LargestEntry() const {
    const double of_cup = cup.size() > 0 ? cup.cwiseAbs().maxCoeff() : 0.0;
    return bodies.size() > 0 ? std::max(of_cup, bodies.cwiseAbs().maxCoeff()) : of_cup;
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
