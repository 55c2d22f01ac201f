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

/// The short way round, of azimuths in [-pi, pi].
double WayBetween(double from, double to) {
  const double way = to - from;
  return way > M_PI ? way - kTurn : way < -M_PI ? way + kTurn : way;
}

/// @param k -kSamples <= k < 2 kSamples.
int WrapSample(int k) { return k < 0 ? k + kSamples : k < kSamples ? k : k - kSamples; }

double At(const Profile& profile, int k) {
  return profile[static_cast<std::size_t>(WrapSample(k))];
}

/// The gap in the middle of an edge that is open between closed ends; 0 of any other edge. [m]
double PeakOver(int a, int b, const std::vector<EdgeWay>& ways) {
  for (const EdgeWay& way : ways) {
    if (std::minmax(way.a, way.b) == std::minmax(a, b)) return way.gap;
  }
  return 0.0;
}

Profile MeridianGaps(const CavitySurface& surface, int cup, const std::vector<double>& gap,
                     const std::vector<EdgeWay>& ways, const Eigen::Matrix3Xd& x_W,
                     const Eigen::Isometry3d& X_WC) {
  const auto begin = static_cast<std::size_t>(surface.first_points[static_cast<std::size_t>(cup)]);
  const auto end =
      static_cast<std::size_t>(surface.first_points[static_cast<std::size_t>(cup) + 1]);
  const Eigen::Isometry3d X_CW = X_WC.inverse();
  std::vector<double> azimuth(surface.nodes.size());
  for (std::size_t point = begin; point < end; ++point) {
    const Eigen::Vector3d p_C = X_CW * x_W.col(surface.nodes[point]);
    azimuth[point] = std::atan2(p_C.y(), p_C.x());
  }
  Profile profile;
  profile.fill(std::numeric_limits<double>::infinity());
  for (std::size_t a = begin; a < end; ++a) {
    for (const int neighbour : surface.neighbours[a]) {
      const auto b = static_cast<std::size_t>(neighbour);
      const double way = WayBetween(azimuth[a], azimuth[b]);
      if (!(way > 0.0)) continue;  // the same edge comes the other way round
      const double per_way = 1.0 / way;
      const double peak = PeakOver(static_cast<int>(a), neighbour, ways);
      const int last = static_cast<int>(std::floor((azimuth[a] + way) / kStep));
      for (int k = static_cast<int>(std::ceil(azimuth[a] / kStep)); k <= last; ++k) {
        const double t = (k * kStep - azimuth[a]) * per_way;
        double& smallest = profile[static_cast<std::size_t>(WrapSample(k))];
        smallest = std::min(
            smallest, (1.0 - t) * gap[a] + t * gap[b] + (1.0 - std::abs(2.0 * t - 1.0)) * peak);
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

SealOpening FindSealOpening(const CavitySurface& surface, int cup, const std::vector<double>& gap,
                            const Classification& classification, double open_gap,
                            const Eigen::Matrix3Xd& x_W, const Eigen::Isometry3d& X_WC) {
  const double bottleneck_gap = classification.bottleneck_gaps[static_cast<std::size_t>(cup)];
  if (!(bottleneck_gap > open_gap)) return {};
  if (std::isinf(bottleneck_gap)) return {0.0, kTurn, bottleneck_gap};
  const Profile profile = MeridianGaps(surface, cup, gap, classification.edge_ways, x_W, X_WC);
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
