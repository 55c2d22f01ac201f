#include "vacuum_gripper_sim/core/seal_opening.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "vacuum_gripper_sim/core/classifier.h"
#include "vacuum_gripper_sim/core/gmsh_reader.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kLip = 0.01875;     // radius of the bell's lip [m]
constexpr double kTop = 0.02;        // height of its mount, and so of the lip in frame M [m]
constexpr double kOpenGap = 1.0e-4;  // m
constexpr double kTurn = 2.0 * M_PI;

double AngleBetween(double a, double b) { return std::abs(std::remainder(a - b, kTurn)); }

/// The opening of a bell at rest, where gaps are given as functions of a point in its mount frame.
class SealOpeningTest : public testing::TestWithParam<const char*> {
 protected:
  using Gap = std::function<double(const Eigen::Vector3d& p_M)>;

  SealOpening Find(const Gap& gap) const {
    // Anywhere in the world: azimuths are those of the mount.
    Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
    X_WM.linear() = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).matrix();
    X_WM.translation() = Eigen::Vector3d(0.3, -0.4, 0.8);
    const Eigen::Matrix3Xd x_M = MountFromRest(mesh_) * mesh_.nodes;
    std::vector<double> phi;
    for (const int node : surface_.nodes) phi.push_back(gap(x_M.col(node)));
    const Classification classification = Classify(surface_, phi, kOpenGap);
    return FindSealOpening(surface_, 0, phi, classification, kOpenGap, X_WM * x_M, X_WM);
  }

  const TetMesh mesh_ =
      ReadGmsh(VACUUM_GRIPPER_SOURCE_DIR "/meshes/bell_" + std::string(GetParam()) + ".msh");
  const CavitySurface surface_ = MakeCavitySurface(mesh_);
  const double sector_ = kTurn / 24.0;  // between the lip's corner nodes [rad]
};

// The lip stands on a tilted plane: its gap is R sin(tilt) (1 + cos(theta - phi)), phi being where
// it is lifted most. Whatever exceeds the tolerance is open.
TEST_P(SealOpeningTest, TiltedCupIsOpenWhereItIsLifted) {
  const double tilt = 5.0 * M_PI / 180.0;
  for (const double lifted : {0.0, 0.7, -0.7, 2.5, -2.0, M_PI}) {
    SCOPED_TRACE(lifted);
    const Eigen::Vector3d direction(std::cos(lifted), std::sin(lifted), 0.0);
    const SealOpening opening = Find([&](const Eigen::Vector3d& p_M) {
      return (kTop - p_M.z()) * std::cos(tilt) + (kLip + p_M.dot(direction)) * std::sin(tilt);
    });
    EXPECT_LT(AngleBetween(opening.azimuth, lifted), 0.5 * sector_);
    const double half_width = std::acos(kOpenGap / (kLip * std::sin(tilt)) - 1.0);
    EXPECT_NEAR(opening.width, 2.0 * half_width, sector_);
    EXPECT_NEAR(opening.largest_gap, 2.0 * kLip * std::sin(tilt), 0.05 * 2.0 * kLip * sin(tilt));
  }
}

// Beyond x = c there is nothing under the lip: open from where the lip crosses the edge, less the
// little way that the tolerance takes.
TEST_P(SealOpeningTest, CupOverAnEdgeIsOpenBeyondIt) {
  for (const double edge : {-0.009, 0.0, 0.009, 0.015}) {
    SCOPED_TRACE(edge);
    const SealOpening opening = Find([&](const Eigen::Vector3d& p_M) {
      return std::hypot(kTop - p_M.z(), std::max(0.0, p_M.x() - edge));
    });
    EXPECT_LT(AngleBetween(opening.azimuth, 0.0), 0.5 * sector_);
    EXPECT_NEAR(opening.width, 2.0 * std::acos((edge + kOpenGap) / kLip), 1.5 * sector_);
    EXPECT_GT(opening.largest_gap, 0.4 * (kLip - edge));  // less: the dome is near the edge, too
  }
}

TEST_P(SealOpeningTest, AirtightCupHasNone) {
  const SealOpening opening = Find([](const Eigen::Vector3d& p_M) { return kTop - p_M.z(); });
  EXPECT_EQ(opening.azimuth, 0.0);
  EXPECT_EQ(opening.width, 0.0);
  EXPECT_EQ(opening.largest_gap, 0.0);
}

TEST_P(SealOpeningTest, FarAwayItIsOpenAllRound) {
  const double tilt = 0.1;
  const SealOpening far = Find([&](const Eigen::Vector3d& p_M) {
    return 0.05 + (kTop - p_M.z()) * std::cos(tilt) + p_M.y() * std::sin(tilt);
  });
  EXPECT_EQ(far.width, kTurn);
  EXPECT_LT(AngleBetween(far.azimuth, M_PI / 2.0), 0.5 * sector_);
  EXPECT_NEAR(far.largest_gap, 0.05 + kLip * std::sin(tilt), 1e-4);

  const double infinity = std::numeric_limits<double>::infinity();
  const SealOpening alone = Find([&](const Eigen::Vector3d&) { return infinity; });
  EXPECT_EQ(alone.width, kTurn);
  EXPECT_EQ(alone.largest_gap, infinity);
  EXPECT_LE(std::abs(alone.azimuth), M_PI);  // not NaN
}

// Two grooves under the lip: the deeper one is reported, as wide as it is.
TEST_P(SealOpeningTest, OfTwoOpeningsTheWiderGapCounts) {
  constexpr double kHalfGroove = 0.6;  // rad
  const SealOpening opening = Find([&](const Eigen::Vector3d& p_M) {
    const double azimuth = std::atan2(p_M.y(), p_M.x());
    double depth = 0.0;
    if (AngleBetween(azimuth, 3.0) < kHalfGroove) depth = 6e-4;
    if (AngleBetween(azimuth, 0.5) < kHalfGroove) depth = 4e-4;
    return kTop - p_M.z() + depth;
  });
  EXPECT_LT(AngleBetween(opening.azimuth, 3.0), 0.5 * sector_);
  EXPECT_NEAR(opening.width, 2.0 * kHalfGroove, 1.5 * sector_);
  EXPECT_NEAR(opening.largest_gap, 6e-4, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Bells, SealOpeningTest, testing::Values("linear_700", "quadratic_700"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace vacuum_gripper_sim
