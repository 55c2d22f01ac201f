#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <tf2_ros/buffer.h>

#include <Eigen/Geometry>
#include <string>

namespace vacuum_gripper_sim {

/// How the mount may go.
struct MotionLimits {
  double max_speed{0.0};               ///< [m/s] > 0
  double max_angular_speed{0.0};       ///< [rad/s] > 0
  double longest_command_period{0.0};  ///< Farther apart, targets are no motion. [s] >= 0
};

/** The thing that holds the mount: goes to where it is told, no faster than its limits, so that a
 far command is a fast motion and not a teleport through the world. Within the limits the mount is
 where it is told to be, exactly, one step after a target that comes by itself, and after each of
 those that come every step.

 Targets that come at an even rate, but more rarely than steps, are a motion: from the second one on
 the mount takes one and a half of their periods to each, and so is still on its way when the next
 comes, be it a little late. One step and a rest instead would be a blow at every command, which the
 cup's mass and the wrench would answer. The mount is then those one and a half periods behind.

 When the simulator had to undo a step, the next attempt goes half as far, again and again, and full
 strides come back as steps succeed. */
class Actuator {
 public:
  /// @param X_WM Where the mount starts. @param time_step h [s].
  Actuator(const Eigen::Isometry3d& X_WM, const MotionLimits& limits, double time_step);

  /// Where to go. @pre A rigid motion.
  void SetTarget(const Eigen::Isometry3d& X_WM);
  const Eigen::Isometry3d& target() const { return X_WM_target_; }
  /// Puts the mount at its target at once, for a reset.
  void JumpToTarget();

  /// Pose of the mount at the end of the step to come.
  Eigen::Isometry3d NextPose() const;
  /// Tells how the step went: where the mount is now and whether the step was undone.
  void OnStep(const Eigen::Isometry3d& X_WM, bool undone);

  /// Is the target too far to be reached in time? @param distance Tolerance [m].
  bool IsBehind(double distance) const;

 private:
  int LongestPeriod() const;
  int LongestPause() const;

  MotionLimits limits_;
  double time_step_;  // [s]
  Eigen::Isometry3d X_WM_;
  Eigen::Isometry3d X_WM_target_;
  double stride_{1.0};           // Part of the motion that the next step makes, (0, 1].
  int steps_since_target_;       // Was set last.
  double target_period_{0.0};    // Of the targets of this motion, on average. [steps] 0: no motion
  double steps_to_target_{1.0};  // That may be spent on the way that is left, >= 1.
};

/** Turns a pose command into the mount's pose in the world.

 The command's frame is looked up at the command's stamp, or as tf knows it last when the stamp is
 zero or tf has nothing for that time (a command stamped "now" is always ahead of tf).

 @throws std::invalid_argument naming the field, its value and what is allowed. */
Eigen::Isometry3d ResolvePoseCommand(const geometry_msgs::PoseStamped& command,
                                     const std::string& world_frame, const tf2_ros::Buffer& tf);

/// Has a frame that tf measured at `stamp` gone quiet? Static frames (stamp zero) never do.
bool IsStale(const ros::Time& stamp);

/** Latest pose of a tf frame in the world.
 @param[out] stamp When tf measured it; zero for a static or identical frame. May be null.
 @throws tf2::TransformException if tf does not know it. */
Eigen::Isometry3d LookUpFrame(const std::string& frame, const std::string& world_frame,
                              const tf2_ros::Buffer& tf, ros::Time* stamp);

}  // namespace vacuum_gripper_sim
