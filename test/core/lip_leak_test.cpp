#include "vacuum_gripper_sim/core/lip_leak.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/gas_flow.h"
#include "vacuum_gripper_sim/core/rough_contact.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kInner = 0.010, kOuter = 0.015;  // radii of the flat lip [m]
constexpr double kModulus = 424e3;                // Pa
constexpr double kAmbient = 101325.0;             // Pa
constexpr double kCavity = 95e3;                  // Pa
constexpr double kTurn = 2.0 * M_PI;

/// A flat annulus from kInner to kOuter under a dome, made of rings.
class FlatLip {
 public:
  static constexpr int kAround = 72;
  static constexpr int kRings = 10;  // of the annulus

  FlatLip() {
    rest.resize(3, 1 + (kRings + 2) * kAround);
    rest.col(0) << 0.0, 0.0, 0.010;
    surface.port = {0};
    for (int i = 0; i < rest.cols(); ++i) surface.nodes.push_back(i);
    for (int ring = 0; ring < kRings + 2; ++ring) {
      const bool is_dome = ring == 0;
      const double radius =
          is_dome ? 0.95 * kInner : kInner + (kOuter - kInner) * (ring - 1) / kRings;
      for (int k = 0; k < kAround; ++k) {
        const double azimuth = kTurn * k / kAround;
        rest.col(Point(ring, k)) << radius * std::cos(azimuth), radius * std::sin(azimuth),
            is_dome ? 0.0002 : 0.0;
        if (ring == kRings + 1) surface.border.push_back(Point(ring, k));
      }
    }
    surface.triangles.resize(3, (3 + 2 * kRings) * kAround);
    for (int k = 0; k < kAround; ++k) {
      AddTriangle(0, Point(0, k), Point(0, k + 1));
      for (int ring = 0; ring <= kRings; ++ring) {
        AddTriangle(Point(ring, k), Point(ring + 1, k), Point(ring + 1, k + 1));
        AddTriangle(Point(ring, k), Point(ring + 1, k + 1), Point(ring, k + 1));
      }
    }
    surface.neighbours.resize(surface.nodes.size());
    for (int t = 0; t < surface.triangles.cols(); ++t) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          if (i == j) continue;
          auto& points = surface.neighbours[static_cast<std::size_t>(surface.triangles(i, t))];
          const int other = surface.triangles(j, t);
          if (std::find(points.begin(), points.end(), other) == points.end()) {
            points.push_back(other);
          }
        }
      }
    }
  }

  static int Point(int ring, int k) { return 1 + ring * kAround + k % kAround; }

  /// Gaps of the annulus as a function of radius and azimuth; 8 mm under the dome, whose wall is
  /// next to it so that what little the air meets there does not count.
  LipContact Contact(const std::function<double(double, double)>& gap) const {
    LipContact contact;
    for (int i = 0; i < rest.cols(); ++i) {
      const bool is_dome = i < Point(1, 0);
      contact.gap.push_back(
          is_dome ? 0.008 : gap(rest.col(i).head<2>().norm(), std::atan2(-rest(1, i), rest(0, i))));
    }
    contact.normal_force.assign(contact.gap.size(), 0.0);
    contact.roughness.assign(contact.gap.size(), 0.0);
    return contact;
  }
  LeakPaths Leak(const LipContact& contact, const std::vector<DirtSector>& dirt = {}) const {
    LeakPaths paths;
    LipLeak(surface, rest, kModulus).Measure(rest, contact, dirt, &paths);
    return paths;
  }

  CavitySurface surface;
  Eigen::Matrix3Xd rest;  // m

 private:
  void AddTriangle(int a, int b, int c) { surface.triangles.col(num_triangles_++) << a, b, c; }
  int num_triangles_{0};
};

const FlatLip& TheFlatLip() {
  static const FlatLip lip;
  return lip;
}

/// Of the whole annulus: Q = (p_1^2 - p_2^2) / (24 mu) shape.
double RingShape(double gap) { return kTurn * std::pow(gap, 3) / std::log(kOuter / kInner); }

TEST(LipLeak, OfAConstantGapIsThatOfAnAnnularSlit) {
  for (const double gap : {5e-6, 20e-6, 50e-6}) {
    const LeakPaths paths =
        TheFlatLip().Leak(TheFlatLip().Contact([&](double, double) { return gap; }));
    const double expected = M_PI * std::pow(gap, 3) * (kAmbient * kAmbient - kCavity * kCavity) /
                            (12.0 * air::kViscosity * std::log(kOuter / kInner));
    EXPECT_NEAR(paths.Throughput(kAmbient, kCavity), expected, 0.01 * expected) << gap;
    EXPECT_EQ(paths.Throughput(kCavity, kAmbient), -paths.Throughput(kAmbient, kCavity));
  }
}

// Each sector by itself: the shape is the integral of g(theta)^3.
TEST(LipLeak, OfATiltedLipIsTheIntegralOverTheAzimuth) {
  const auto gap = [](double azimuth) { return 30e-6 + 20e-6 * std::cos(azimuth - 0.4); };
  const LeakPaths paths =
      TheFlatLip().Leak(TheFlatLip().Contact([&](double, double azimuth) { return gap(azimuth); }));
  double expected = 0.0;
  constexpr int kParts = 1000;
  for (int i = 0; i < kParts; ++i) expected += RingShape(gap(kTurn * i / kParts)) / kParts;
  const double throughput = paths.Throughput(kAmbient, kCavity);
  EXPECT_NEAR(throughput, SlitThroughput(expected, kAmbient, kCavity), 0.01 * throughput);
  // Azimuths are those of the mount: the widest sector is where the gap is widest.
  const auto widest =
      std::max_element(paths.sectors.begin(), paths.sectors.end(),
                       [](const LeakPath& a, const LeakPath& b) { return a.shape < b.shape; });
  EXPECT_NEAR(LipMeridians::Azimuth(static_cast<int>(widest - paths.sectors.begin())), 0.4, 0.06);
}

TEST(LipLeak, OfARadialWedgeIsTheIntegralAlongTheMeridian) {
  for (const double narrow : {5e-6, 10e-6, 25e-6}) {
    const auto gap = [&](double radius) {
      return narrow + 60e-6 * (radius - kInner) / (kOuter - kInner);
    };
    const LeakPaths paths =
        TheFlatLip().Leak(TheFlatLip().Contact([&](double radius, double) { return gap(radius); }));
    double resistance = 0.0;
    constexpr int kParts = 100000;
    const double step = (kOuter - kInner) / kParts;
    for (int i = 0; i < kParts; ++i) {
      const double radius = kInner + (i + 0.5) * step;
      resistance += step / (kTurn * radius * std::pow(gap(radius), 3));
    }
    const double expected = SlitThroughput(1.0 / resistance, kAmbient, kCavity);
    EXPECT_NEAR(paths.Throughput(kAmbient, kCavity), expected, 0.01 * expected) << narrow;
  }
}

TEST(LipLeak, OfAWideGapIsThatOfAnOrifice) {
  constexpr double kGap = 1e-3;  // m
  const LeakPaths paths =
      TheFlatLip().Leak(TheFlatLip().Contact([](double, double) { return kGap; }));
  const double area = kTurn * kInner * kGap;
  EXPECT_NEAR(paths.area(), area, 0.06 * area);  // the dome's edge is 5 % narrower than kInner
  EXPECT_LT(area, paths.area() * 1.01);
  for (const double cavity : {kCavity, 1e4}) {
    EXPECT_NEAR(paths.Throughput(kAmbient, cavity),
                OrificeThroughput(paths.area(), kAmbient, cavity), 1e-9);
    EXPECT_NEAR(paths.EquivalentArea(kAmbient, cavity), paths.area(), 1e-6 * area);
  }
  EXPECT_EQ(paths.Throughput(kAmbient, 1e4), paths.Throughput(kAmbient, 2e4));  // choked
}

TEST(LipLeak, WithoutSurfacesIsThatOfTheMouth) {
  const LeakPaths paths = TheFlatLip().Leak(
      TheFlatLip().Contact([](double, double) { return std::numeric_limits<double>::infinity(); }));
  EXPECT_LT(paths.area(), M_PI * kOuter * kOuter);
  EXPECT_GT(paths.area(), 0.3 * M_PI * kOuter * kOuter);
  EXPECT_EQ(paths.Throughput(kAmbient, kAmbient), 0.0);
  EXPECT_EQ(paths.EquivalentArea(kAmbient, kAmbient), 0.0);
}

TEST(LipLeak, RisesWithThePressureDifference) {
  const LeakPaths paths = TheFlatLip().Leak(TheFlatLip().Contact([](double, double azimuth) {
    return 200e-6 * (1.0 + std::cos(azimuth));  // slits and orifices
  }));
  double last = 0.0;
  for (double p = kAmbient - 100.0; p > 0.0; p -= 100.0) {
    const double throughput = paths.Throughput(kAmbient, p);
    EXPECT_GE(throughput, last) << p;
    last = throughput;
  }
}

TEST(LipLeak, OfASmoothLipThatTouchesAllRoundIsZero) {
  for (const double ring : {0.0, 0.5, 1.0}) {  // wherever it touches
    const double touching = kInner + ring * (kOuter - kInner);
    LipContact contact = TheFlatLip().Contact(
        [&](double radius, double) { return 10e-6 + 0.1 * std::abs(radius - touching); });
    contact.tolerance = 10.001e-6;
    EXPECT_EQ(TheFlatLip().Leak(contact).Throughput(kAmbient, kCavity), 0.0);
    contact.tolerance = 9.9e-6;
    EXPECT_GT(TheFlatLip().Leak(contact).Throughput(kAmbient, kCavity), 0.0);
  }
}

// Lifting bit by bit: from nothing on without a jump, and never less.
TEST(LipLeak, RisesContinuouslyAsTheLipLetsGo) {
  for (const double rough : {0.0, 10e-6}) {
    std::vector<double> throughputs;
    for (double lift = -0.1e-3; lift < 0.2e-3; lift += 1e-6) {
      LipContact contact = TheFlatLip().Contact([&](double radius, double azimuth) {
        return std::max(0.0, lift * (1.0 + 0.3 * std::cos(azimuth)) +
                                 0.05 * std::abs(radius - 0.5 * (kInner + kOuter)));
      });
      contact.tolerance = 50e-6;
      contact.roughness.assign(contact.gap.size(), rough);
      throughputs.push_back(TheFlatLip().Leak(contact).Throughput(kAmbient, kCavity));
    }
    EXPECT_LT(throughputs.front(), 0.01 * throughputs.back());
    for (std::size_t i = 1; i < throughputs.size(); ++i) {
      EXPECT_GE(throughputs[i], throughputs[i - 1]) << i;
      EXPECT_LT(throughputs[i] - throughputs[i - 1], 0.02 * throughputs.back()) << i;
    }
  }
}

TEST(LipLeak, DirtLeaksInProportionToItsWidth) {
  const LipContact contact = TheFlatLip().Contact([](double, double) { return 0.0; });
  constexpr double kDirt = 20e-6;  // m
  const double all = SlitThroughput(RingShape(kDirt), kAmbient, kCavity);
  for (const double width : {0.005, 0.02, 0.1, 0.5, 3.0, kTurn - 0.005, kTurn}) {
    for (const double azimuth : {0.0, 0.017, -3.1}) {
      const LeakPaths paths = TheFlatLip().Leak(contact, {{azimuth, width, kDirt}});
      EXPECT_NEAR(paths.Throughput(kAmbient, kCavity), all * width / kTurn,
                  0.01 * all * width / kTurn)
          << azimuth << ", " << width;
    }
  }
  EXPECT_EQ(TheFlatLip().Leak(contact, {{0.0, 0.0, kDirt}}).Throughput(kAmbient, kCavity), 0.0);
  // The highest of several counts.
  EXPECT_EQ(TheFlatLip()
                .Leak(contact, {{0.0, kTurn, 5e-6}, {1.0, kTurn, kDirt}, {2.0, kTurn, 8e-6}})
                .Throughput(kAmbient, kCavity),
            TheFlatLip().Leak(contact, {{0.0, kTurn, kDirt}}).Throughput(kAmbient, kCavity));
}

// The whole annulus touches with the force F: p = F / area.
TEST(LipLeak, RoughnessLeaksAsItsHydraulicGap) {
  const double area = M_PI * (kOuter * kOuter - kInner * kInner);
  double last = std::numeric_limits<double>::infinity();
  for (const double force : {0.0, 1.0, 10.0, 100.0}) {
    LipContact contact = TheFlatLip().Contact([](double, double) { return 0.0; });
    contact.roughness.assign(contact.gap.size(), 10e-6);
    for (int k = 0; k < FlatLip::kAround; k += 2) {  // on every other point of one ring
      contact.normal_force[static_cast<std::size_t>(FlatLip::Point(5, k))] =
          2.0 * force / FlatLip::kAround;
    }
    const double throughput = TheFlatLip().Leak(contact).Throughput(kAmbient, kCavity);
    const double gap = HydraulicGap(10e-6, force / area, kModulus);
    const double expected = SlitThroughput(RingShape(gap), kAmbient, kCavity);
    EXPECT_NEAR(throughput, expected, 0.02 * expected) << force;
    EXPECT_LT(throughput, last);
    last = throughput;

    contact.roughness.assign(contact.gap.size(), 20e-6);
    EXPECT_NEAR(TheFlatLip().Leak(contact).Throughput(kAmbient, kCavity), 8.0 * throughput,
                0.001 * 8.0 * throughput);
  }
}

TEST(LipLeak, LeaksOnTheRoughSideAlone) {
  LipContact contact = TheFlatLip().Contact([](double, double) { return 0.0; });
  contact.roughness.assign(contact.gap.size(), 10e-6);
  const double all = TheFlatLip().Leak(contact).Throughput(kAmbient, kCavity);
  for (std::size_t i = 0; i < contact.roughness.size(); ++i) {
    if (TheFlatLip().rest(0, static_cast<Eigen::Index>(i)) < 0.0) contact.roughness[i] = 0.0;
  }
  EXPECT_NEAR(TheFlatLip().Leak(contact).Throughput(kAmbient, kCavity), 0.5 * all, 0.02 * all);
}

TEST(LipLeak, DoesNotDependOnWhereTheCupIs) {
  const FlatLip& lip = TheFlatLip();
  LipContact contact = lip.Contact([](double radius, double azimuth) {
    return 20e-6 + 0.01 * (radius - kInner) + 10e-6 * std::sin(azimuth);
  });
  contact.roughness.assign(contact.gap.size(), 5e-6);
  Eigen::Isometry3d X_WR = Eigen::Isometry3d::Identity();
  X_WR.linear() = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1.0, -0.5, 0.3).normalized()).matrix();
  X_WR.translation() = Eigen::Vector3d(0.5, -0.3, 1.1);
  LipLeak leak(lip.surface, lip.rest, kModulus);
  LeakPaths here, there;
  leak.Measure(lip.rest, contact, {}, &here);
  leak.Measure(X_WR * lip.rest, contact, {}, &there);
  for (std::size_t k = 0; k < here.sectors.size(); ++k) {
    EXPECT_NEAR(there.sectors[k].shape, here.sectors[k].shape, 1e-9 * here.sectors[k].shape);
    EXPECT_NEAR(there.sectors[k].area, here.sectors[k].area, 1e-9 * here.sectors[k].area);
  }
  // A cup twice as large has a lip as long, seen along and across.
  leak.Measure(2.0 * lip.rest, contact, {}, &there);
  EXPECT_NEAR(there.Throughput(kAmbient, kCavity), here.Throughput(kAmbient, kCavity),
              1e-9 * here.Throughput(kAmbient, kCavity));
}

TEST(LipLeak, RefusesContactsOfOtherSurfaces) {
  LipContact contact = TheFlatLip().Contact([](double, double) { return 0.0; });
  contact.roughness.pop_back();
  EXPECT_THROW(TheFlatLip().Leak(contact), std::invalid_argument);
}

}  // namespace
}  // namespace vacuum_gripper_sim
