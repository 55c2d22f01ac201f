#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "physics/grip_cycle.h"
#include "vacuum_gripper_sim/core/rigid_object.h"

namespace vacuum_gripper_sim {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]

/// A solid box of uniform density, free to move, its centre at `position`.
inline RigidObject FreeBox(const Eigen::Vector3d& size, double mass, double friction,
                           const Eigen::Vector3d& position) {
  RigidObject box = FixedObject(RigidSurface{"box", Box{size}});
  box.surfaces[0].friction = friction;
  box.X_WO.translation() = position;
  RigidInertia inertia;
  inertia.mass = mass;
  const Eigen::Vector3d squares = size.cwiseAbs2();
  inertia.about_C_O =
      (mass / 12.0 * (Eigen::Vector3d::Constant(squares.sum()) - squares)).asDiagonal();
  box.inertia = inertia;
  return box;
}

inline RigidObject Table(double friction,
                         const Eigen::Isometry3d& X_WS = Eigen::Isometry3d::Identity()) {
  RigidSurface plane{"table", Plane{}, X_WS};
  plane.friction = friction;
  return FixedObject(plane);
}

/// The A20, pointing down, among objects. The whole scene may be posed anywhere by X_AW.
class GripWorld {
 public:
  GripWorld(std::vector<RigidObject> objects, const Eigen::Vector3d& mount,
            SimulatorParameters parameters, const std::string& bell = "linear_700",
            const Eigen::Isometry3d& X_AW = Eigen::Isometry3d::Identity())
      : h_(parameters.time_step),
        X_AW_(X_AW),
        X_WM_(Down(mount)),
        simulator_(LoadBell(bell), Turned(parameters, X_AW), X_AW * X_WM_) {
    for (RigidObject& object : objects) object.X_WO = X_AW * object.X_WO;
    simulator_.SetObjects(std::move(objects));
  }

  void MoveTo(const Eigen::Vector3d& mount, double speed, double setpoint) {
    while (X_WM_.translation() != mount) {
      const Eigen::Vector3d way = mount - X_WM_.translation();
      X_WM_.translation() =
          way.norm() <= speed * h_
              ? mount
              : Eigen::Vector3d(X_WM_.translation() + way.normalized() * speed * h_);
      Step(setpoint);
    }
  }
  void Wait(double time, double setpoint) {
    for (int i = 0; i < std::lround(time / h_); ++i) Step(setpoint);
  }
  /// Turns the mount about its origin, about y of the world.
  void Turn(double angle) {
    X_WM_.linear() =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix() * X_WM_.linear();
  }
  void Step(double setpoint) {
    simulator_.Step({X_AW_ * X_WM_, setpoint});
    undone_steps += result().outcome != StepOutcome::kOk ? 1 : 0;
    max_penetration = std::max(max_penetration, result().max_penetration);
    iterations = std::max(iterations, result().solver_iterations);
    time_spent += result().timings.total;
    ++steps;
    linear_iterations += result().linear_iterations;
    if (after_step) after_step(result());
  }
  const StepResult& result() const { return simulator_.result(); }
  const ObjectResult& object(int i) const { return result().objects[static_cast<std::size_t>(i)]; }
  Eigen::Vector3d force_W() const { return result().X_WM.linear() * result().force_M; }
  Simulator& simulator() { return simulator_; }
  Eigen::Vector3d mount() const { return X_WM_.translation(); }

  int undone_steps{0};
  int iterations{0};
  int steps{0};
  int linear_iterations{0};
  double time_spent{0.0};
  double max_penetration{0.0};
  std::function<void(const StepResult&)> after_step;  ///< Called with every step's result.

 private:
  static Eigen::Isometry3d Down(const Eigen::Vector3d& mount) {
    Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
    X_WM.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    X_WM.translation() = mount;
    return X_WM;
  }
  static SimulatorParameters Turned(SimulatorParameters parameters, const Eigen::Isometry3d& X_AW) {
    parameters.gravity = X_AW.linear() * parameters.gravity;
    return parameters;
  }
  double h_;
  Eigen::Isometry3d X_AW_;
  Eigen::Isometry3d X_WM_;
  Simulator simulator_;
};

inline SimulatorParameters WithGravity(SimulatorParameters parameters) {
  parameters.gravity = Eigen::Vector3d(0.0, 0.0, -kGravity);
  return parameters;
}

}  // namespace vacuum_gripper_sim
