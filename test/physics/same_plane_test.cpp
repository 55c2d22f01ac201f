#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "physics/grip_cycle.h"
#include "support/surface_meshes.h"
#include "vacuum_gripper_sim/core/triangle_mesh.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kWidth = 0.2;  // five times the cup's

struct Forces {
  double pressed;  // by 1 mm [N]
  double held;     // at -6 kPa [N]
  double pulled;   // lifted by 2 mm [N]
};

/// A grip of what lies at z = 0 of frame S. Poses: identity but for `lift` of S along z.
Forces Grip(const Shape& shape, double lift = 0.0) {
  GripCycle cycle(LoadBell("linear_700"), A20(0.01));
  RigidSurface surface{"plate", shape};
  surface.X_FS.translation().z() = lift;
  cycle.simulator().SetObjects({FixedObject(surface)});
  Forces forces{};
  cycle.Drive(kCupLength - 0.001, 0.02, 0.0, 0.2);
  forces.pressed = cycle.result().force_M.z();
  cycle.Drive(kCupLength - 0.001, 0.02, -6000.0, 0.3);
  EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
  forces.held = cycle.result().force_M.z();
  cycle.Drive(kCupLength + 0.002, 0.02, -6000.0, 0.3);
  EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
  forces.pulled = cycle.result().force_M.z();
  EXPECT_EQ(cycle.seal_flips, 1);
  EXPECT_EQ(cycle.undone_steps, 0);
  EXPECT_LE(cycle.max_penetration, 1e-6);
  return forces;
}

void ExpectSame(const Forces& forces, const Forces& expected, double tolerance) {
  EXPECT_NEAR(forces.pressed, expected.pressed, tolerance * std::abs(expected.pressed));
  EXPECT_NEAR(forces.held, expected.held, tolerance * std::abs(expected.held));
  EXPECT_NEAR(forces.pulled, expected.pulled, tolerance * std::abs(expected.pulled));
  std::printf("pressed %.6f, held %.6f, pulled %.6f N\n", forces.pressed, forces.held,
              forces.pulled);
}

Shape Share(const Triangles& mesh) {
  return std::make_shared<const TriangleMesh>("mesh", mesh.vertices, mesh.triangles);
}

class SamePlane : public testing::Test {
 protected:
  static const Forces& Plate() {
    static const Forces forces = Grip(Plane{});
    return forces;
  }
};

TEST_F(SamePlane, AsBox) { ExpectSame(Grip(Box{{kWidth, kWidth, 0.1}}, -0.05), Plate(), 1e-6); }

// Within the cup's radius of 20 mm the sphere falls by r^2 / 2 R = 2e-8 m.
TEST_F(SamePlane, AsHugeSphere) {
  const double radius = 1e4;
  ExpectSame(Grip(Sphere{radius}, -radius), Plate(), 0.005);
}

TEST_F(SamePlane, AsSheetOfTwoTriangles) {
  ExpectSame(Grip(Share(MakeSheet(1, kWidth))), Plate(), 0.005);
}

TEST_F(SamePlane, AsSheetOf20000Triangles) {
  ExpectSame(Grip(Share(MakeSheet(100, kWidth))), Plate(), 0.005);
}

TEST_F(SamePlane, AsClosedMeshOf20000Triangles) {
  const Triangles box = MakeBoxMesh(41, {kWidth, kWidth, 0.1});
  EXPECT_GT(box.triangles.cols(), 20000);
  ExpectSame(Grip(Share(box), -0.05), Plate(), 0.005);
}

// Two boxes that meet under the cup: several surfaces, of which the nearest counts.
TEST_F(SamePlane, AsTwoBoxesWithASeam) {
  GripCycle cycle(LoadBell("linear_700"), A20(0.01));
  std::vector<RigidObject> boxes;
  for (const double side : {-1.0, 1.0}) {
    RigidSurface box{"box", Box{{0.5 * kWidth, kWidth, 0.1}}};
    box.X_FS.translation() = Eigen::Vector3d(side * 0.25 * kWidth + 0.0031, 0.0, -0.05);
    boxes.push_back(FixedObject(box));
  }
  cycle.simulator().SetObjects(boxes);
  cycle.Drive(kCupLength - 0.001, 0.02, 0.0, 0.2);
  cycle.Drive(kCupLength - 0.001, 0.02, -6000.0, 0.3);
  EXPECT_EQ(cycle.result().status, SealStatus::kSealed);
  EXPECT_NEAR(cycle.result().force_M.z(), Plate().held, 0.005 * Plate().held);
}

}  // namespace
}  // namespace vacuum_gripper_sim
