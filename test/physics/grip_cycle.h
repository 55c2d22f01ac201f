#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/gmsh_reader.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {

constexpr double kCupLength = 0.020;  ///< Mount to lip of the bell at rest. [m]

inline TetMesh LoadBell(const std::string& name) {
  return ReadGmsh(std::string(VACUUM_GRIPPER_SOURCE_DIR) + "/meshes/bell_" + name + ".msh");
}

inline SimulatorParameters A20(double time_step) {
  SimulatorParameters parameters;
  parameters.time_step = time_step;
  parameters.gravity.setZero();
  parameters.material = {338000.0, 0.45, 1080.0};
  return parameters;
}

inline bool Holds(const StepResult& result) { return Holds(result.status); }

/** A cup over a plane through the origin of its world, driven along the plane's normal; watches
 what a whole cycle must never do. The world may be posed anywhere: X_AW maps what is said here
 (plane z = 0, heights along z) to the simulated world. */
class GripCycle {
 public:
  GripCycle(TetMesh mesh, SimulatorParameters parameters,
            const Eigen::Isometry3d& X_AW = Eigen::Isometry3d::Identity())
      : X_AW_(X_AW),
        h_(parameters.time_step),
        simulator_(std::move(mesh), TurnGravity(parameters), MountPose(kCupLength + 1e-4)) {
    simulator_.SetObjects({FixedObject(RigidSurface{"plate", Plane{}, X_AW_})});
  }

  /// Moves the mount to `height` above the plane at `speed` and steps on for `then` seconds.
  void Drive(double height, double speed, double setpoint, double then = 0.0) {
    while (height_ != height) {
      const double way = height - height_;
      height_ = std::abs(way) <= speed * h_ ? height : height_ + std::copysign(speed * h_, way);
      Step(setpoint);
    }
    for (int i = 0; i < std::lround(then / h_); ++i) Step(setpoint);
  }

  /// Lifts until the grip is lost, at most to `height`; then for `then` seconds on.
  void PullUntilLost(double height, double speed, double setpoint, double then) {
    while (height_ < height && Holds(result())) {
      height_ += speed * h_;
      Step(setpoint);
      peak_force = std::max(peak_force, result().force_M.z());
    }
    lift_at_loss = height_ - kCupLength;
    for (int i = 0; i < std::lround(then / h_); ++i) {
      height_ += speed * h_;
      Step(setpoint);
    }
  }

  void Step(double setpoint) {
    const bool held = Holds(result());
    simulator_.Step({MountPose(height_), setpoint});
    seal_flips += Holds(result()) != held ? 1 : 0;
    undone_steps += result().outcome != StepOutcome::kOk ? 1 : 0;
    max_penetration = std::max(max_penetration, result().max_penetration);
  }

  const StepResult& result() const { return simulator_.result(); }
  Simulator& simulator() { return simulator_; }
  double height() const { return height_; }  ///< Of the mount above the plane. [m]

  int seal_flips{0};
  int undone_steps{0};
  double max_penetration{0.0};  // m
  double peak_force{0.0};       // N, while pulling
  double lift_at_loss{0.0};     // m

 private:
  SimulatorParameters TurnGravity(SimulatorParameters parameters) const {
    parameters.gravity = X_AW_.linear() * parameters.gravity;
    return parameters;
  }
  Eigen::Isometry3d MountPose(double height) const {
    Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
    X_WM.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    X_WM.translation().z() = height;
    return X_AW_ * X_WM;
  }

  Eigen::Isometry3d X_AW_;
  double h_;
  double height_{kCupLength + 1e-4};
  Simulator simulator_;
};

}  // namespace vacuum_gripper_sim
