#include "vacuum_gripper_sim/core/rigid_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

RigidSurface At(const Shape& shape, const Vector3d& position = Vector3d::Zero()) {
  RigidSurface surface{"thing", shape};
  surface.X_FS.translation() = position;
  return surface;
}

void ExpectDistance(const RigidSurface& surface, const Vector3d& p, double distance,
                    const Vector3d& normal) {
  const SurfaceDistance seen = Distance(surface, p);
  EXPECT_NEAR(seen.distance, distance, 1e-15);
  EXPECT_LT((seen.normal - normal).norm(), 1e-14);
}

TEST(Distance, Plane) {
  RigidSurface plane = At(Plane{}, {0.0, 0.0, 0.1});
  ExpectDistance(plane, {3.0, 2.0, 0.3}, 0.2, Vector3d::UnitZ());
  ExpectDistance(plane, {3.0, 2.0, 0.0}, -0.1, Vector3d::UnitZ());
  plane.X_FS.linear() = Eigen::AngleAxisd(M_PI / 2.0, Vector3d::UnitY()).matrix();  // z -> x
  ExpectDistance(plane, {0.4, 5.0, 6.0}, 0.4, Vector3d::UnitX());
}

TEST(Distance, BoxFaceEdgeCornerAndInside) {
  const RigidSurface box = At(Box{{2.0, 4.0, 6.0}});
  ExpectDistance(box, {0.0, 0.0, 3.5}, 0.5, Vector3d::UnitZ());
  ExpectDistance(box, {-1.3, 2.4, 0.0}, 0.5, Vector3d(-0.6, 0.8, 0.0));
  ExpectDistance(box, {2.0, 4.0, -5.0}, 3.0, Vector3d(1.0, 2.0, -2.0) / 3.0);
  ExpectDistance(box, {0.7, 0.0, 0.0}, -0.3, Vector3d::UnitX());
  ExpectDistance(box, {0.0, -1.9, 0.0}, -0.1, -Vector3d::UnitY());
}

TEST(Distance, Sphere) {
  const RigidSurface sphere = At(Sphere{0.5}, {1.0, 0.0, 0.0});
  ExpectDistance(sphere, {1.0, 2.0, 0.0}, 1.5, Vector3d::UnitY());
  ExpectDistance(sphere, {0.9, 0.0, 0.0}, -0.4, -Vector3d::UnitX());
  EXPECT_NEAR(Distance(sphere, {1.0, 0.0, 0.0}).normal.norm(), 1.0, 1e-15);
}

TEST(Distance, Cylinder) {
  const RigidSurface cylinder = At(Cylinder{1.0, 4.0});
  ExpectDistance(cylinder, {0.0, 3.0, 1.0}, 2.0, Vector3d::UnitY());
  ExpectDistance(cylinder, {0.5, 0.0, -2.5}, 0.5, -Vector3d::UnitZ());
  ExpectDistance(cylinder, {1.3, 0.0, 2.4}, 0.5, Vector3d(0.6, 0.0, 0.8));
  ExpectDistance(cylinder, {0.0, -0.8, 0.0}, -0.2, -Vector3d::UnitY());
  EXPECT_NEAR(Distance(cylinder, {0.0, 0.0, 0.0}).normal.norm(), 1.0, 1e-15);
}

// The normal is the gradient of the distance, for every shape in a general pose.
TEST(Distance, NormalIsTheGradient) {
  for (const Shape& shape : {Shape(Plane{}), Shape(Box{{0.3, 0.2, 0.4}}), Shape(Sphere{0.2}),
                             Shape(Cylinder{0.2, 0.3})}) {
    RigidSurface surface = At(shape, {0.1, -0.2, 0.3});
    surface.X_FS.linear() = Eigen::AngleAxisd(0.9, Vector3d(1.0, 1.0, -0.5).normalized()).matrix();
    for (int i = 0; i < 50; ++i) {
      const Vector3d p(0.6 * std::sin(1.0 + i), 0.6 * std::cos(2.0 * i), 0.6 * std::sin(3.0 * i));
      const double step = 1e-6;
      Vector3d gradient;
      for (int k = 0; k < 3; ++k) {
        gradient(k) = (Distance(surface, p + step * Vector3d::Unit(k)).distance -
                       Distance(surface, p - step * Vector3d::Unit(k)).distance) /
                      (2.0 * step);
      }
      EXPECT_LT((Distance(surface, p).normal - gradient).norm(), 1e-4) << shape.index() << ' ' << i;
    }
  }
}

TEST(ValidateSurface, RefusesBadNumbersByName) {
  EXPECT_NO_THROW(Validate(At(Box{{1.0, 1.0, 1.0}})));
  const auto expect_refused = [](const RigidSurface& surface, const std::string& word) {
    try {
      Validate(surface);
      FAIL() << "accepted " << word;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("thing"), std::string::npos) << error.what();
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused(At(Box{{1.0, -1.0, 1.0}}), "size y");
  expect_refused(At(Sphere{0.0}), "radius");
  expect_refused(At(Cylinder{1.0, nan}), "length");
  expect_refused(At(Plane{}, {0.0, nan, 0.0}), "pose");
  RigidSurface scaled = At(Plane{});
  scaled.X_FS.linear() *= 2.0;
  expect_refused(scaled, "pose");
}

}  // namespace
}  // namespace vacuum_gripper_sim
