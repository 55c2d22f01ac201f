#include "actuator.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

constexpr double kQuaternionTolerance = 1e-3;  // Of the norm; what a rounded quaternion is off by.
constexpr double kSmallestStride = 1.0 / 1024.0;
constexpr double kPeriodsToTarget = 1.5;
// From one step to these periods, as targets become rarer than steps.
constexpr double kRamp = 4.0;
constexpr double kWeightOfNewest = 0.25;  // In the average period.

Eigen::Isometry3d ToIsometry(const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = position;
  X.linear() = rotation.normalized().toRotationMatrix();
  return X;
}

Eigen::Isometry3d ToIsometry(const geometry_msgs::Transform& t) {
  return ToIsometry(Eigen::Vector3d(t.translation.x, t.translation.y, t.translation.z),
                    Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z));
}

/// Farther out, doubles are too coarse for gaps of micrometres.
bool IsNearOrigin(const Eigen::Isometry3d& X_WM) {
  constexpr double kFarthest = 1.0e+4;  // [m]
  return X_WM.translation().cwiseAbs().maxCoeff() <= kFarthest;
}

void CheckFinite(const char* field, double value) {
  if (!std::isfinite(value)) {
    std::ostringstream reason;
    reason << field << " = " << value << " must be finite";
    throw std::invalid_argument(reason.str());
  }
}

}  // namespace

Actuator::Actuator(const Eigen::Isometry3d& X_WM, const MotionLimits& limits, double time_step)
    : limits_(limits),
      time_step_(time_step),
      X_WM_(X_WM),
      X_WM_target_(X_WM),
      steps_since_target_(1 + LongestPause()) {}

/// Targets farther apart than this do not begin a motion.
int Actuator::LongestPeriod() const {
  constexpr double kRounding = 1e-6;
  return static_cast<int>(limits_.longest_command_period / time_step_ + kRounding);
}

/// After more steps than this without a target a motion is over; one that comes late does not end
/// it.
int Actuator::LongestPause() const { return 2 * LongestPeriod(); }

void Actuator::SetTarget(const Eigen::Isometry3d& X_WM) {
  X_WM_target_ = X_WM;
  if (steps_since_target_ == 0) return;  // It replaces one that came in the same step.
  if (target_period_ > 0.0 && steps_since_target_ <= LongestPause()) {
    target_period_ += kWeightOfNewest * (steps_since_target_ - target_period_);
  } else {
    target_period_ = steps_since_target_ <= LongestPeriod() ? steps_since_target_ : 0.0;
  }
  // At once while there is a target for every step, and from there on without a jump.
  steps_to_target_ = std::max(
      1.0, std::min(kPeriodsToTarget * target_period_, 1.0 + kRamp * (target_period_ - 1.0)));
  steps_since_target_ = 0;
}

void Actuator::JumpToTarget() {
  X_WM_ = X_WM_target_;
  stride_ = 1.0;
  steps_to_target_ = 1.0;
}

Eigen::Isometry3d Actuator::NextPose() const {
  const Eigen::Vector3d way = X_WM_target_.translation() - X_WM_.translation();
  const Eigen::Quaterniond from(X_WM_.linear());
  const Eigen::Quaterniond to(X_WM_target_.linear());
  const double angle = from.angularDistance(to);
  const double reach = limits_.max_speed * time_step_;
  const double turn = limits_.max_angular_speed * time_step_;

  double fraction = 1.0 / steps_to_target_;  // Translation and rotation arrive together.
  if (way.norm() > reach) fraction = std::min(fraction, reach / way.norm());
  if (angle > turn) fraction = std::min(fraction, turn / angle);
  fraction *= stride_;
  if (fraction == 1.0) return X_WM_target_;
  return ToIsometry(X_WM_.translation() + fraction * way, from.slerp(fraction, to));
}

void Actuator::OnStep(const Eigen::Isometry3d& X_WM, bool undone) {
  X_WM_ = X_WM;
  stride_ = undone ? std::max(kSmallestStride, 0.5 * stride_) : std::min(1.0, 2.0 * stride_);
  if (!undone) steps_to_target_ = std::max(1.0, steps_to_target_ - 1.0);
  steps_since_target_ = std::min(steps_since_target_ + 1, 1 + LongestPause());
}

bool Actuator::IsBehind(double distance) const {
  const double reach = (steps_to_target_ - 1.0) * limits_.max_speed * time_step_;
  return (X_WM_target_.translation() - X_WM_.translation()).norm() > reach + distance;
}

Eigen::Isometry3d ResolvePoseCommand(const geometry_msgs::PoseStamped& command,
                                     const std::string& world_frame, const tf2_ros::Buffer& tf) {
  const geometry_msgs::Point& p = command.pose.position;
  const geometry_msgs::Quaternion& q = command.pose.orientation;
  CheckFinite("pose.position.x", p.x);
  CheckFinite("pose.position.y", p.y);
  CheckFinite("pose.position.z", p.z);
  CheckFinite("pose.orientation.x", q.x);
  CheckFinite("pose.orientation.y", q.y);
  CheckFinite("pose.orientation.z", q.z);
  CheckFinite("pose.orientation.w", q.w);
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (!(std::abs(rotation.norm() - 1.0) <= kQuaternionTolerance)) {
    std::ostringstream reason;
    reason << "pose.orientation = [" << q.x << ", " << q.y << ", " << q.z << ", " << q.w
           << "] has norm " << rotation.norm() << ", must be 1 within " << kQuaternionTolerance;
    throw std::invalid_argument(reason.str());
  }
  const std::string& frame = command.header.frame_id;
  if (frame.empty()) {
    throw std::invalid_argument("header.frame_id is empty, must be a frame that tf knows");
  }

  Eigen::Isometry3d X_WF = Eigen::Isometry3d::Identity();
  try {
    const ros::Time stamp = command.header.stamp;
    if (frame != world_frame && !stamp.isZero() && tf.canTransform(world_frame, frame, stamp)) {
      X_WF = ToIsometry(tf.lookupTransform(world_frame, frame, stamp).transform);
    } else {
      X_WF = LookUpFrame(frame, world_frame, tf, nullptr);
    }
  } catch (const tf2::TransformException& error) {
    throw std::invalid_argument("header.frame_id = '" + frame + "' cannot be resolved to '" +
                                world_frame + "' by tf: " + error.what());
  }
  const Eigen::Isometry3d X_WM = X_WF * ToIsometry(Eigen::Vector3d(p.x, p.y, p.z), rotation);
  if (!IsNearOrigin(X_WM)) {
    throw std::invalid_argument("pose.position is too far from the origin of '" + world_frame +
                                "', must be within 10 km");
  }
  return X_WM;
}

Eigen::Isometry3d LookUpFrame(const std::string& frame, const std::string& world_frame,
                              const tf2_ros::Buffer& tf, ros::Time* stamp) {
  if (stamp != nullptr) *stamp = ros::Time();
  if (frame == world_frame) return Eigen::Isometry3d::Identity();
  const geometry_msgs::TransformStamped X_WF = tf.lookupTransform(world_frame, frame, ros::Time(0));
  if (stamp != nullptr) *stamp = X_WF.header.stamp;
  const Eigen::Isometry3d pose = ToIsometry(X_WF.transform);
  if (!pose.matrix().allFinite() || !IsNearOrigin(pose)) {
    throw tf2::TransformException("tf of '" + frame + "' is not finite or farther than 10 km");
  }
  return pose;
}

bool IsStale(const ros::Time& stamp) {
  constexpr double kStaleAfter = 1.0;  // [s]
  // In doubles: the difference of two ros::Times throws when it is longer than 68 years.
  return !stamp.isZero() && ros::Time::now().toSec() - stamp.toSec() > kStaleAfter;
}

}  // namespace vacuum_gripper_sim
