#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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

/// The linear A20, pointing down, among objects.
class GripWorld {
 public:
  GripWorld(const std::vector<RigidObject>& objects, const Eigen::Vector3d& mount,
            SimulatorParameters parameters, const std::string& bell = "linear_700")
      : h_(parameters.time_step), simulator_(LoadBell(bell), parameters, Down(mount)) {
    simulator_.SetObjects(objects);
    X_WM_ = Down(mount);
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
  void Step(double setpoint) {
    simulator_.Step({X_WM_, setpoint});
    undone_steps += result().outcome != StepOutcome::kOk ? 1 : 0;
    max_penetration = std::max(max_penetration, result().max_penetration);
    iterations = std::max(iterations, result().solver_iterations);
    time_spent += result().timings.total;
    ++steps;
  }
  const StepResult& result() const { return simulator_.result(); }
  const ObjectResult& object(int i) const { return result().objects[static_cast<std::size_t>(i)]; }
  Eigen::Vector3d force_W() const { return result().X_WM.linear() * result().force_M; }
  Simulator& simulator() { return simulator_; }
  Eigen::Vector3d mount() const { return X_WM_.translation(); }

  int undone_steps{0};
  int iterations{0};
  int steps{0};
  double time_spent{0.0};
  double max_penetration{0.0};

 private:
  static Eigen::Isometry3d Down(const Eigen::Vector3d& mount) {
    Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
    X_WM.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    X_WM.translation() = mount;
    return X_WM;
  }
  double h_;
  Eigen::Isometry3d X_WM_;
  Simulator simulator_;
};

inline SimulatorParameters WithGravity(SimulatorParameters parameters) {
  parameters.gravity = Eigen::Vector3d(0.0, 0.0, -kGravity);
  return parameters;
}

}  // namespace vacuum_gripper_sim
