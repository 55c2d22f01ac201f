#include "vacuum_gripper_sim/core/holding_trial.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// How far a grip is moved that does not fail before: cups are some centimetres high.
constexpr double kLongestWay = 0.03;    // m
constexpr double kLongestTurn = 0.8;    // rad
constexpr double kLongestSlide = 5e-3;  // m; sliding, a grip bears no more than before
/// A load across the axis below this part of all that contacts carry, with the rims' radius as
/// lever where it is a moment, has no direction: meshes are not quite round.
constexpr double kNoLoad = 0.02;

/// The part of v across z, or x if that is less than `none`; a unit vector.
Vector3d DirectionAcross(const Vector3d& v, double none) {
  const Vector3d across(v.x(), v.y(), 0.0);
  return across.norm() > none ? across.normalized() : Vector3d::UnitX();
}

/// Middle of the rims in the mount frame. [m]
Vector3d MiddleOfRims(const CavitySurface& cavity, const Snapshot& moment) {
  Vector3d sum_W = Vector3d::Zero();
  for (const int point : cavity.border) {
    sum_W += moment.x_W.col(cavity.nodes[static_cast<std::size_t>(point)]);
  }
  return moment.command.X_WM.inverse() * (sum_W / static_cast<double>(cavity.border.size()));
}

/// Farthest point of the rims from that middle, across the suction axis. [m]
double RadiusOfRims(const CavitySurface& cavity, const Snapshot& moment, const Vector3d& middle_M) {
  double radius = 0.0;
  for (const int point : cavity.border) {
    const Vector3d p_M = moment.command.X_WM.inverse() *
                         moment.x_W.col(cavity.nodes[static_cast<std::size_t>(point)]);
    radius = std::max(radius, (p_M - middle_M).head<2>().norm());
  }
  return radius;
}

/// A trial takes its time, and no thread from the simulation beside which it is made.
SimulatorParameters OnOneThread(SimulatorParameters parameters) {
  parameters.linear_solver.threads = 1;
  return parameters;
}

}  // namespace

/// One of the three ways to fail: a screw of the mount, and the load that counts. Mount axes.
struct HoldingTrial::Motion {
  Vector3d velocity{Vector3d::Zero()};  // m/s
  Vector3d turn{Vector3d::Zero()};      // rad/s
  Vector3d about{Vector3d::Zero()};     // point that it turns about, moments too [m]
  double duration{0.0};                 // at most [s]
  Vector3d force_direction{Vector3d::Zero()};
  Vector3d moment_direction{Vector3d::Zero()};

  Isometry3d PoseAfter(double time) const {
    const double angle = turn.norm() * time;
    Isometry3d X = Isometry3d::Identity();
    X.translation() = velocity * time;
    if (angle == 0.0) return X;
    X.linear() = Eigen::AngleAxisd(angle, turn.normalized()).toRotationMatrix();
    X.translation() += about - X.linear() * about;
    return X;
  }
  double Load(const Vector3d& force, const Vector3d& torque) const {
    return force_direction.dot(force) + moment_direction.dot(torque - about.cross(force));
  }
};

HoldingTrial::HoldingTrial(const TetMesh& mesh, const SimulatorParameters& parameters)
    : simulator_(mesh, OnOneThread(parameters)) {}

HoldingReserve HoldingTrial::Measure(const Snapshot& moment) {
  HoldingReserve margin;
  margin.time = moment.time;
  Snapshot clamped = moment;
  for (RigidObject& object : clamped.objects) object.inertia.reset();
  simulator_.Restore(clamped);
  const StepResult now = simulator_.Step(moment.command);
  margin.holds = now.outcome == StepOutcome::kOk && Holds(now.status);
  if (!margin.holds) return margin;

  Motion pull;
  pull.velocity = -kSpeed * Vector3d::UnitZ();
  pull.duration = kLongestWay / kSpeed;
  pull.force_direction = Vector3d::UnitZ();  // the cup pulls its mount towards the object
  margin.normal_force = Bear(clamped, pull);

  Motion shear;
  // The mount is held back by what it carries: it moves against that force.
  shear.force_direction = DirectionAcross(now.force_M, kNoLoad * now.contact_force);
  shear.velocity = -kSpeed * shear.force_direction;
  shear.duration = kLongestSlide / kSpeed;
  margin.shear_force = Bear(clamped, shear);

  Motion tilt;
  tilt.about = MiddleOfRims(simulator_.cavity(), moment);
  const double radius = RadiusOfRims(simulator_.cavity(), moment, tilt.about);
  tilt.moment_direction = DirectionAcross(now.torque_M - tilt.about.cross(now.force_M),
                                          kNoLoad * now.contact_force * radius);
  tilt.turn = -kSpeed / radius * tilt.moment_direction;
  tilt.duration = kLongestTurn * radius / kSpeed;
  margin.tilting_moment = Bear(clamped, tilt);
  return margin;
}

/// How much more than at the start a motion finds at most. [N] or [N m]
double HoldingTrial::Bear(const Snapshot& moment, const Motion& motion) {
  simulator_.Restore(moment);
  const double h = simulator_.parameters().time_step;
  Command command = moment.command;
  const StepResult& result = simulator_.Step(command);
  const Eigen::Matrix3d R_WM = moment.command.X_WM.linear();
  const auto load = [&] {
    // In the axes that the mount had at the start, about its origin there.
    const Eigen::Matrix3d R = R_WM.transpose() * result.X_WM.linear();
    const Vector3d origin = moment.command.X_WM.inverse() * result.X_WM.translation();
    const Vector3d force = R * result.force_M;
    return motion.Load(force, R * result.torque_M + origin.cross(force));
  };
  const double at_start = load();
  double most = at_start;
  for (double time = h; time <= motion.duration; time += h) {
    command.X_WM = moment.command.X_WM * motion.PoseAfter(time);
    simulator_.Step(command);
    if (result.outcome != StepOutcome::kOk || !Holds(result.status)) break;
    most = std::max(most, load());
  }
  return most - at_start;
}

}  // namespace vacuum_gripper_sim
