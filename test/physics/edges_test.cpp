// Sharp edges and corners against the wall of the cup, between its nodes: by brute force, at the
// end of every step no point of an edge is behind a face.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "physics/grip_world.h"
#include "vacuum_gripper_sim/core/cup_faces.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

/// What a straight edge may be behind a bent face between two of its points that are held. [m]
constexpr double kBetween = 5e-5;
/// What it may be behind where a sharp edge of the cup crosses it. [m]
constexpr double kCrossing = 1e-4;
const Vector3d kMount(0.0, 0.0, kCupLength);  // the lip at z = 0

/// Points along the twelve edges of a box, in its frame.
std::vector<Vector3d> EdgesOf(const Vector3d& size, double spacing) {
  std::vector<Vector3d> points;
  for (int along = 0; along < 3; ++along) {
    for (int side = 0; side < 4; ++side) {
      Vector3d p = 0.5 * size;
      if ((side & 1) != 0) p((along + 1) % 3) *= -1.0;
      if ((side & 2) != 0) p((along + 2) % 3) *= -1.0;
      const auto count = static_cast<int>(size(along) / spacing);
      for (int i = 0; i <= count; ++i) {
        p(along) = size(along) * (static_cast<double>(i) / count - 0.5);
        points.push_back(p);
      }
    }
  }
  return points;
}

/// Fixed boxes around the cup, and where their edges are.
class Edges {
 public:
  Edges(const std::vector<RigidObject>& boxes, const SimulatorParameters& parameters,
        const Vector3d& mount = kMount)
      : world_(boxes, mount, parameters), faces_(world_.simulator().mesh()) {
    for (const RigidObject& box : boxes) {
      points_O_.push_back(EdgesOf(std::get<Box>(box.surfaces[0].shape).size, 2.5e-4));
    }
    Watch();
  }
  void MoveTo(const Vector3d& mount, double speed) {
    const Vector3d way = mount - world_.mount();
    const auto steps = static_cast<int>(std::ceil(way.norm() / (speed * kStep)));
    const Vector3d start = world_.mount();
    for (int i = 1; i <= steps; ++i) {
      world_.MoveTo(start + way * (static_cast<double>(i) / steps), 1.0, 0.0);
      Watch();
    }
  }
  void MoveObject(int object, const Vector3d& way, double speed) {
    const auto steps = static_cast<int>(std::ceil(way.norm() / (speed * kStep)));
    for (int i = 0; i < steps; ++i) {
      const Eigen::Isometry3d X_WO =
          world_.simulator().objects()[static_cast<std::size_t>(object)].X_WO;
      world_.simulator().SetObjectPose(object, Eigen::Translation3d(way / steps) * X_WO);
      world_.Step(0.0);
      Watch();
    }
  }
  /// Of the edges of a box, wherever the cup is in reach. [m]
  double Nearest(int object) const {
    double nearest = std::numeric_limits<double>::infinity();
    const ObjectResult& now = world_.object(object);
    for (const Vector3d& p_O : points_O_[static_cast<std::size_t>(object)]) {
      const std::optional<CupFacePoint> seen = faces_.Nearest(now.X_WO * p_O, 5e-3);
      if (seen) nearest = std::min(nearest, seen->distance);
    }
    return nearest;
  }
  const GripWorld& world() const { return world_; }
  double deepest() const { return deepest_; }
  static constexpr double kStep = 0.01;  // s

 private:
  void Watch() {
    faces_.Update(world_.result().x_W);
    for (std::size_t i = 0; i < points_O_.size(); ++i) {
      deepest_ = std::max(deepest_, -Nearest(static_cast<int>(i)));
    }
  }
  GripWorld world_;
  CupFaces faces_;
  std::vector<std::vector<Vector3d>> points_O_;
  double deepest_{0.0};  // m
};

RigidObject BoxAt(const Vector3d& size, const Vector3d& position, const Eigen::Matrix3d& R,
                  double friction = 0.0) {
  RigidObject box = FixedObject(RigidSurface{"box", Box{size}});
  box.X_WO.linear() = R;
  box.X_WO.translation() = position;
  box.surfaces[0].friction = friction;
  return box;
}

Eigen::Matrix3d Turned(double angle, const Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

class EdgesTest : public testing::TestWithParam<LinearSolverMethod> {
 protected:
  static SimulatorParameters Parameters() {
    SimulatorParameters parameters = A20(Edges::kStep);
    parameters.linear_solver.method = GetParam();
    return parameters;
  }
};

// From the side, at heights between the rings of nodes, along the ring and upright.
TEST_P(EdgesTest, BladeIsPressedIntoTheWall) {
  for (const bool upright : {false, true}) {
    for (const double height : {0.0047, 0.0083}) {
      SCOPED_TRACE(testing::Message() << (upright ? "upright" : "level") << " at " << height);
      const Eigen::Matrix3d R =
          upright ? Turned(0.25 * M_PI, Vector3d::UnitZ()) : Turned(0.25 * M_PI, Vector3d::UnitY());
      const Vector3d size = upright ? Vector3d(0.006, 0.006, 0.004) : Vector3d(0.006, 0.02, 0.006);
      Edges edges({BoxAt(size, {0.03, 0.0007, height}, R, 0.3)}, Parameters());
      while (edges.Nearest(0) > 3e-4) edges.MoveObject(0, {-2e-4, 0.0, 0.0}, 0.02);
      edges.MoveObject(0, {-2.5e-3, 0.0, 0.0}, 0.02);
      EXPECT_GT(edges.world().object(0).force_W.x(), 0.02);  // it is pushed back
      EXPECT_LT(edges.deepest(), kBetween);
      EXPECT_EQ(edges.world().undone_steps, 0);
      edges.MoveObject(0, {0.01, 0.0, 0.0}, 0.05);  // and away: contacts are gone, none is missed
      EXPECT_EQ(edges.world().object(0).force_W.norm(), 0.0);
      EXPECT_EQ(edges.world().undone_steps, 0);
    }
  }
}

// Edges of two boxes run across under the lip, a slot of 1 mm between them and one 1 mm higher.
TEST_P(EdgesTest, LipIsPressedOnASeam) {
  const Vector3d size(0.03, 0.04, 0.01);
  Edges edges({BoxAt(size, {-0.0155, 0.0, -0.006}, Eigen::Matrix3d::Identity(), 0.3),
               BoxAt(size, {0.0155, 0.0, -0.005}, Eigen::Matrix3d::Identity(), 0.3)},
              Parameters(), kMount + Vector3d(0.0003, 0.0002, 5e-4));
  edges.MoveTo(kMount + Vector3d(0.0003, 0.0002, -3e-3), 0.02);
  edges.MoveTo(kMount + Vector3d(0.0023, 0.0002, -3e-3), 0.02);
  EXPECT_GT(edges.world().object(0).force_W.norm(), 0.1);
  EXPECT_GT(edges.world().object(1).force_W.norm(), 0.1);
  EXPECT_LT(edges.deepest(), kCrossing);
  EXPECT_EQ(edges.world().undone_steps, 0);
}

// A corner that reaches the cavity's ceiling before the lip reaches anything.
TEST_P(EdgesTest, CornerIsPressedIntoTheCavity) {
  const double side = 0.008;
  // The diagonal upright.
  const Eigen::Matrix3d R =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::Ones(), Vector3d::UnitZ()).toRotationMatrix();
  Edges edges(
      {BoxAt(Vector3d::Constant(side), {0.0031, 0.0004, -0.5 * std::sqrt(3.0) * side - 1e-3}, R)},
      Parameters());
  while (edges.Nearest(0) > 3e-4) edges.MoveObject(0, {0.0, 0.0, 2e-4}, 0.02);
  edges.MoveObject(0, {0.0, 0.0, 1.5e-3}, 0.02);
  EXPECT_GT(edges.world().object(0).force_W.norm(), 0.05);
  EXPECT_LT(edges.deepest(), kBetween);
  EXPECT_EQ(edges.world().undone_steps, 0);
}

INSTANTIATE_TEST_SUITE_P(Solvers, EdgesTest,
                         testing::Values(LinearSolverMethod::kDirect,
                                         LinearSolverMethod::kConjugateGradient),
                         [](const auto& info) {
                           return info.param == LinearSolverMethod::kDirect ? "direct"
                                                                            : "conjugate_gradient";
                         });

}  // namespace
}  // namespace vacuum_gripper_sim
