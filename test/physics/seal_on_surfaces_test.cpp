// What a cup seals on and what it does not: curved, tilted, stepped and ending surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "physics/grip_cycle.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kLip = 0.01875;  // radius of the bell's lip [m]

RigidSurface Body(const std::string& name, const Shape& shape, const Eigen::Vector3d& position,
                  const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity()) {
  Eigen::Isometry3d X_FS = Eigen::Isometry3d::Identity();
  X_FS.linear() = rotation;
  X_FS.translation() = position;
  return RigidSurface{name, shape, X_FS};
}

/// A box of 0.1 m whose top face is at `top` and whose face towards -x is at x = `left`.
RigidSurface BoxFrom(double left, double top) {
  return Body("box", Box{{0.1, 0.1, 0.1}}, {left + 0.05, 0.0, top - 0.05});
}

/// The same with its face towards +x at x = `right`.
RigidSurface BoxTo(double right, double top) {
  return Body("box", Box{{0.1, 0.1, 0.1}}, {right - 0.05, 0.0, top - 0.05});
}

Eigen::Matrix3d Rotation(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// The linear bell comes down on surfaces from where its lip is 1 mm above z = 0, presses by a
/// depth below it, and suction is switched on.
class SealTest : public testing::Test {
 protected:
  const StepResult& Grip(std::vector<RigidSurface> surfaces, double depth, double tilt = 0.0) {
    Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
    X_WM.linear() =
        Rotation(tilt, Eigen::Vector3d::UnitY()) * Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    const auto pose_at = [&](double lip) {
      // The lip's centre stays over the origin.
      X_WM.translation() = Eigen::Vector3d(0.0, 0.0, lip) - kCupLength * X_WM.linear().col(2);
      return X_WM;
    };
    constexpr double kAbove = 1e-3;
    constexpr int kDown = 30, kHold = 30;
    simulator_ = std::make_unique<Simulator>(LoadBell("linear_700"), A20(0.01), pose_at(kAbove));
    std::vector<RigidObject> objects;
    for (RigidSurface& surface : surfaces) objects.push_back(FixedObject(std::move(surface)));
    simulator_->SetObjects(std::move(objects));
    for (int i = 1; i <= kDown; ++i) {
      Step({pose_at(kAbove - (kAbove + depth) * i / kDown), 0.0});
    }
    for (int i = 0; i < kHold; ++i) Step({pose_at(-depth), -6000.0});
    return simulator_->result();
  }

  void ExpectSealed() {
    const StepResult& result = simulator_->result();
    EXPECT_EQ(result.status, SealStatus::kSealed);
    EXPECT_EQ(result.gauge_pressure, -6000.0);
    EXPECT_EQ(result.opening.width, 0.0);
    EXPECT_EQ(undone_steps_, 0);
    EXPECT_LE(max_penetration_, 1e-6);
  }

  void ExpectLeak() {
    const StepResult& result = simulator_->result();
    EXPECT_EQ(result.status, SealStatus::kOpen);
    EXPECT_EQ(result.gauge_pressure, 0.0);
    EXPECT_GT(result.bottleneck_gap, *simulator_->parameters().seal.open_gap);
    EXPECT_EQ(undone_steps_, 0);
    EXPECT_LE(max_penetration_, 1e-6);
  }

 private:
  void Step(const Command& command) {
    const StepResult& result = simulator_->Step(command);
    undone_steps_ += result.outcome == StepOutcome::kOk ? 0 : 1;
    max_penetration_ = std::max(max_penetration_, result.max_penetration);
  }

  std::unique_ptr<Simulator> simulator_;
  int undone_steps_{0};
  double max_penetration_{0.0};  // m
};

/// Height that a circle of radius r rises over a chord that the lip spans. [m]
double Sagitta(double r) { return r - std::sqrt(r * r - kLip * kLip); }

TEST_F(SealTest, OnASphere) {
  constexpr double kRadius = 0.06;
  Grip({Body("ball", Sphere{kRadius}, {0.0, 0.0, Sagitta(kRadius) - kRadius})}, 0.001);
  ExpectSealed();
}

// Along its axis the bottle is as high as at its top, across it the lip has to reach down.
TEST_F(SealTest, OnACylinder) {
  constexpr double kRadius = 0.06;
  Grip({Body("bottle", Cylinder{kRadius, 0.2}, {0.0, 0.0, -kRadius},
             Rotation(M_PI / 2.0, Eigen::Vector3d::UnitX()))},
       Sagitta(kRadius) + 0.001);
  ExpectSealed();
}

TEST_F(SealTest, NotOnACylinderThatIsTooSlender) {
  constexpr double kRadius = 0.025;
  const StepResult& result = Grip({Body("pipe", Cylinder{kRadius, 0.2}, {0.0, 0.0, -kRadius},
                                        Rotation(M_PI / 2.0, Eigen::Vector3d::UnitX()))},
                                  0.002);
  ExpectLeak();
  // Open to both sides; along the pipe, at pi / 2 and -pi / 2, the lip stands on it.
  EXPECT_LT(std::min(std::abs(result.opening.azimuth), M_PI - std::abs(result.opening.azimuth)),
            0.3);
  EXPECT_GT(result.opening.width, 0.5);
  EXPECT_LT(result.opening.width, M_PI);
}

TEST_F(SealTest, OnAPlaneTiltedByFiveDegrees) {
  const double tilt = 5.0 * M_PI / 180.0;
  Grip({Body("plate", Plane{}, Eigen::Vector3d::Zero())}, 2.0 * kLip * std::sin(tilt), tilt);
  ExpectSealed();
}

// Not pressed enough, the lip that is lifted stays open.
TEST_F(SealTest, NotWhereATiltedLipIsLifted) {
  const double tilt = 5.0 * M_PI / 180.0;
  for (const double sign : {1.0, -1.0}) {
    const StepResult& result =
        Grip({Body("plate", Plane{}, Eigen::Vector3d::Zero())}, 0.0, sign * tilt);
    ExpectLeak();
    // Turned about +y, the side of the cup towards +x sinks and the one towards -x is lifted.
    const double lifted = sign > 0.0 ? M_PI : 0.0;
    EXPECT_LT(std::abs(std::remainder(result.opening.azimuth - lifted, 2.0 * M_PI)), 0.15);
    const double rigid = kLip * std::sin(tilt);  // of a cup that did not give way
    EXPECT_GT(result.opening.largest_gap, 0.3 * rigid);
    EXPECT_LT(result.opening.largest_gap, rigid);
  }
}

TEST_F(SealTest, AcrossAStepFinerThanTheTolerance) {
  Grip({BoxTo(0.0, 0.0), BoxFrom(0.0, -5e-5)}, 0.001);
  ExpectSealed();
}

TEST_F(SealTest, NotAcrossAStepOfTwoMillimetres) {
  const StepResult& result = Grip({BoxTo(0.0, 0.0), BoxFrom(0.0, -0.002)}, 0.001);
  ExpectLeak();
  EXPECT_LT(std::abs(result.opening.azimuth), 0.3);  // over the lower box, towards +x
}

TEST_F(SealTest, NotHalfOverAnEdge) {
  const StepResult& result = Grip({BoxTo(0.0, 0.0)}, 0.001);
  ExpectLeak();
  EXPECT_LT(std::abs(result.opening.azimuth), 0.1);
  EXPECT_NEAR(result.opening.width, M_PI, 0.4);
}

TEST_F(SealTest, NotWithLessThanHalfOfTheLipOverAnEdge) {
  const StepResult& result = Grip({BoxTo(kLip / 3.0, 0.0)}, 0.001);
  ExpectLeak();
  EXPECT_LT(std::abs(result.opening.azimuth), 0.1);
  EXPECT_NEAR(result.opening.width, 2.0 * std::acos(1.0 / 3.0), 0.4);
}

// Two boxes side by side, as good as one.
TEST_F(SealTest, AcrossASeam) {
  const double on_one = Grip({BoxTo(0.05, 0.0)}, 0.001).force_M.z();
  ExpectSealed();
  const double on_two = Grip({BoxTo(0.003, 0.0), BoxFrom(0.003, 0.0)}, 0.001).force_M.z();
  ExpectSealed();
  EXPECT_NEAR(on_two, on_one, 1e-6 * on_one);
}

}  // namespace
}  // namespace vacuum_gripper_sim
