#include "vacuum_gripper_sim/core/classifier.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

enum class Basin : std::uint8_t { kNone, kPort, kBorder };

/// Calls visit(point, gap) for the far end of every way across an edge that begins at `point`.
template <typename Visitor>
void ForWaysFrom(int point, const std::vector<EdgeWay>& ways, const Visitor& visit) {
  for (const EdgeWay& way : ways) {
    if (way.from == point) visit(way.to, way.gap);
    if (way.to == point) visit(way.from, way.gap);
  }
}

/// The two floods: which basin owns each point, and the lowest phi on the way there from its seed.
struct Watershed {
  std::vector<Basin> basin;
  std::vector<double> bottleneck;
};

/** Grows both basins at once, always by the point of the largest phi at their shores (Prim's
 algorithm with two roots): before any point below some level is taken, all that the seeds reach
 above it are. So the widest way between the seeds crosses from one basin to the other at an edge
 whose two bottlenecks are at least its own. */
Watershed Flood(const CavitySurface& surface, const std::vector<double>& phi,
                const std::vector<EdgeWay>& ways) {
  struct Shore {
    double phi;  // of the point, or of a narrower way to it
    int order;   // first come, first served among equals: the outcome depends on the input alone
    int point;
    int parent;
    Basin basin;
    bool operator<(const Shore& other) const {
      return phi != other.phi ? phi < other.phi : order > other.order;
    }
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Watershed flood{std::vector<Basin>(phi.size(), Basin::kNone),
                  std::vector<double>(phi.size(), kInfinity)};
  std::priority_queue<Shore> shores;
  int order = 0;
  for (const int point : surface.port)
    shores.push({phi[static_cast<std::size_t>(point)], order++, point, -1, Basin::kPort});
  for (const int point : surface.border) {
    shores.push({phi[static_cast<std::size_t>(point)], order++, point, -1, Basin::kBorder});
  }
  while (!shores.empty()) {
    const Shore shore = shores.top();
    shores.pop();
    const auto point = static_cast<std::size_t>(shore.point);
    if (flood.basin[point] != Basin::kNone) continue;
    flood.basin[point] = shore.basin;
    const double upstream =
        shore.parent < 0 ? kInfinity : flood.bottleneck[static_cast<std::size_t>(shore.parent)];
    flood.bottleneck[point] = std::min(shore.phi, upstream);
    for (const int next : surface.neighbours[point]) {
      if (flood.basin[static_cast<std::size_t>(next)] != Basin::kNone) continue;
      shores.push({phi[static_cast<std::size_t>(next)], order++, next, shore.point, shore.basin});
    }
    ForWaysFrom(shore.point, ways, [&](int next, double gap) {
      const double level = std::min(gap, phi[static_cast<std::size_t>(next)]);
      shores.push({level, order++, next, shore.point, shore.basin});
    });
  }
  return flood;
}

double BottleneckGap(const CavitySurface& surface, const Watershed& flood,
                     const std::vector<EdgeWay>& ways) {
  double widest = -std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < surface.neighbours.size(); ++a) {
    for (const int neighbour : surface.neighbours[a]) {
      const auto b = static_cast<std::size_t>(neighbour);
      if (flood.basin[a] == flood.basin[b]) continue;
      widest = std::max(widest, std::min(flood.bottleneck[a], flood.bottleneck[b]));
    }
  }
  for (const EdgeWay& way : ways) {
    const auto a = static_cast<std::size_t>(way.from), b = static_cast<std::size_t>(way.to);
    if (flood.basin[a] == flood.basin[b]) continue;
    widest = std::max(widest, std::min({way.gap, flood.bottleneck[a], flood.bottleneck[b]}));
  }
  return widest;
}

/// The open points that open points join to one of the seeds.
std::vector<bool> ReachThroughOpen(const CavitySurface& surface, const std::vector<bool>& open,
                                   const std::vector<int>& seeds,
                                   const std::vector<EdgeWay>& ways) {
  std::vector<bool> reached(open.size(), false);
  std::vector<int> stack;
  const auto visit = [&](int point) {
    const auto i = static_cast<std::size_t>(point);
    if (!open[i] || reached[i]) return;
    reached[i] = true;
    stack.push_back(point);
  };
  for (const int seed : seeds) visit(seed);
  while (!stack.empty()) {
    const int point = stack.back();
    stack.pop_back();
    for (const int next : surface.neighbours[static_cast<std::size_t>(point)]) visit(next);
    ForWaysFrom(point, ways, [&](int next, double) { visit(next); });
  }
  return reached;
}

bool Touches(const std::vector<int>& neighbours, const std::vector<bool>& region) {
  return std::any_of(neighbours.begin(), neighbours.end(),
                     [&](int n) { return region[static_cast<std::size_t>(n)]; });
}

/// The zone of one point; `inside` is empty of points when the cavity is open.
Zone ZoneOf(const std::vector<int>& neighbours, std::size_t point, const std::vector<bool>& outside,
            const std::vector<bool>& inside) {
  if (outside[point]) return Zone::kStrictlyOutside;
  if (inside[point]) return Zone::kStrictlyInside;
  // In this order: Algorithm 1 takes the inner border from what the outer one left.
  if (Touches(neighbours, outside)) return Zone::kOuterBorder;
  if (Touches(neighbours, inside)) return Zone::kInnerBorder;
  return Zone::kInActiveContact;
}

}  // namespace

Classification Classify(const CavitySurface& surface, const std::vector<double>& phi,
                        double open_gap, const std::vector<bool>& was_wet,
                        std::vector<EdgeWay> edge_ways) {
  const std::size_t num_points = surface.nodes.size();
  if (phi.size() != num_points || (!was_wet.empty() && was_wet.size() != num_points)) {
    throw std::invalid_argument("Classify: one phi and one was_wet a point of the surface");
  }

  const Watershed flood = Flood(surface, phi, edge_ways);
  Classification result;
  result.bottleneck_gap = BottleneckGap(surface, flood, edge_ways);

  std::vector<bool> open(num_points);
  for (std::size_t i = 0; i < num_points; ++i) open[i] = phi[i] > open_gap;
  std::vector<bool> outside = ReachThroughOpen(surface, open, surface.border, edge_ways);
  std::vector<bool> inside = ReachThroughOpen(surface, open, surface.port, edge_ways);

  result.wet.resize(num_points);
  for (std::size_t i = 0; i < num_points; ++i) {
    const bool trapped = open[i] && !outside[i] && !inside[i];
    const bool keeps_suction = !was_wet.empty() && was_wet[i];
    result.wet[i] = trapped ? keeps_suction : flood.basin[i] == Basin::kPort;
  }

  const bool joined = result.bottleneck_gap > open_gap;
  if (joined) inside.assign(num_points, false);
  result.zones.resize(num_points);
  for (std::size_t i = 0; i < num_points; ++i) {
    result.zones[i] = ZoneOf(surface.neighbours[i], i, outside, inside);
    ++result.zone_counts[static_cast<std::size_t>(result.zones[i])];
  }
  result.edge_ways = std::move(edge_ways);
  return result;
}

}  // namespace vacuum_gripper_sim
