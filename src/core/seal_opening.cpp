#include "vacuum_gripper_sim/core/seal_opening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vacuum_gripper_sim {
namespace {

constexpr int kSamples = 180;
constexpr double kTurn = 2.0 * M_PI;
constexpr double kStep = kTurn / kSamples;  // rad

/// The smallest gap of the meridian at azimuth k kStep, for k = 0 .. kSamples - 1. [m]
using Profile = std::array<double, kSamples>;

double WrapToPi(double angle) { return std::remainder(angle, kTurn); }

int WrapSample(int k) { return ((k % kSamples) + kSamples) % kSamples; }

double At(const Profile& profile, int k) {
  return profile[static_cast<std::size_t>(WrapSample(k))];
}

Profile MeridianGaps(const CavitySurface& surface, const std::vector<double>& gap,
                     const Eigen::Matrix3Xd& x_W, const Eigen::Isometry3d& X_WM) {
  const Eigen::Isometry3d X_MW = X_WM.inverse();
  std::vector<double> azimuth;
  for (const int node : surface.nodes) {
    const Eigen::Vector3d p_M = X_MW * x_W.col(node);
    azimuth.push_back(std::atan2(p_M.y(), p_M.x()));
  }
  Profile profile;
  profile.fill(std::numeric_limits<double>::infinity());
  for (std::size_t a = 0; a < azimuth.size(); ++a) {
    for (const int neighbour : surface.neighbours[a]) {
      const auto b = static_cast<std::size_t>(neighbour);
      const double way = WrapToPi(azimuth[b] - azimuth[a]);
      if (way <= 0.0) continue;  // the same edge comes the other way round
      const int last = static_cast<int>(std::floor((azimuth[a] + way) / kStep));
      for (int k = static_cast<int>(std::ceil(azimuth[a] / kStep)); k <= last; ++k) {
        const double t = (k * kStep - azimuth[a]) / way;
        double& smallest = profile[static_cast<std::size_t>(WrapSample(k))];
        smallest = std::min(smallest, (1.0 - t) * gap[a] + t * gap[b]);
      }
    }
  }
  return profile;
}

/// How far beyond an open sample, towards a closed one, the gap passes open_gap. [rad]
double WayToClosed(double open, double closed, double open_gap) {
  return kStep * (open - open_gap) / (open - closed);
}

}  // namespace

SealOpening FindSealOpening(const CavitySurface& surface, const std::vector<double>& gap,
                            double bottleneck_gap, double open_gap, const Eigen::Matrix3Xd& x_W,
                            const Eigen::Isometry3d& X_WM) {
  if (!(bottleneck_gap > open_gap)) return {};
  if (std::isinf(bottleneck_gap)) return {0.0, kTurn, bottleneck_gap};
  const Profile profile = MeridianGaps(surface, gap, x_W, X_WM);
  const int widest =
      static_cast<int>(std::max_element(profile.begin(), profile.end()) - profile.begin());
  const auto is_open = [&](int k) { return At(profile, k) > open_gap; };
  if (!is_open(widest)) return {WrapToPi(widest * kStep), kStep, bottleneck_gap};

  int first = widest, last = widest;  // of the open samples
  while (last - first + 1 < kSamples && is_open(last + 1)) ++last;
  while (last - first + 1 < kSamples && is_open(first - 1)) --first;
  if (last - first + 1 == kSamples) return {WrapToPi(widest * kStep), kTurn, bottleneck_gap};
  const double begin =
      first * kStep - WayToClosed(At(profile, first), At(profile, first - 1), open_gap);
  const double end = last * kStep + WayToClosed(At(profile, last), At(profile, last + 1), open_gap);
  return {WrapToPi(0.5 * (begin + end)), end - begin, bottleneck_gap};
}

}  // namespace vacuum_gripper_sim
