#include "vacuum_gripper_sim/core/classifier.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

/// Calls visit(point, gap) for the far end of every way across an edge that begins at `point`.
template <typename Visitor>
void ForWaysFrom(int point, const std::vector<EdgeWay>& ways, const Visitor& visit) {
  for (const EdgeWay& way : ways) {
    if (way.from == point) visit(way.to, way.gap);
    if (way.to == point) visit(way.from, way.gap);
  }
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

/** Grows both basins at once, always by the point of the largest phi at their shores (Prim's
 algorithm with two roots): before any point below some level is taken, all that the seeds reach
 above it are. So the widest way between the seeds crosses from one basin to the other at an edge
 whose two bottlenecks are at least its own. Of the ways to a point that are no narrower than the
 point, the one found first counts; after that it is not queued again. */
void Classifier::Flood(const std::vector<double>& phi, const std::vector<EdgeWay>& ways) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  basin_.assign(phi.size(), Basin::kNone);
  bottleneck_.assign(phi.size(), kInfinity);
  reached_in_full_.assign(phi.size(), false);
  shores_.clear();
  int order = 0;
  const auto reach = [&](int point, double width, int parent, Basin basin) {
    const auto i = static_cast<std::size_t>(point);
    if (reached_in_full_[i]) return;
    reached_in_full_[i] = width >= phi[i];
    PushShore({std::min(width, phi[i]), order++, point, parent, basin});
  };
  for (const int point : surface_->port) reach(point, kInfinity, -1, Basin::kPort);
  for (const int point : surface_->border) reach(point, kInfinity, -1, Basin::kBorder);
  while (!shores_.empty()) {
    std::pop_heap(shores_.begin(), shores_.end());
    const Shore shore = shores_.back();
    shores_.pop_back();
    const auto point = static_cast<std::size_t>(shore.point);
    if (basin_[point] != Basin::kNone) continue;
    basin_[point] = shore.basin;
    const double upstream =
        shore.parent < 0 ? kInfinity : bottleneck_[static_cast<std::size_t>(shore.parent)];
    bottleneck_[point] = std::min(shore.phi, upstream);
    for (const int next : surface_->neighbours[point]) {
      reach(next, kInfinity, shore.point, shore.basin);
    }
    ForWaysFrom(shore.point, ways,
                [&](int next, double gap) { reach(next, gap, shore.point, shore.basin); });
  }
}

void Classifier::PushShore(const Shore& shore) {
  shores_.push_back(shore);
  std::push_heap(shores_.begin(), shores_.end());
}

double Classifier::BottleneckGap(int cup, const std::vector<EdgeWay>& ways) const {
  const auto k = static_cast<std::size_t>(cup);
  const auto begin = static_cast<std::size_t>(surface_->first_points[k]);
  const auto end = static_cast<std::size_t>(surface_->first_points[k + 1]);
  double widest = -std::numeric_limits<double>::infinity();
  for (std::size_t a = begin; a < end; ++a) {
    for (const int neighbour : surface_->neighbours[a]) {
      const auto b = static_cast<std::size_t>(neighbour);
      if (basin_[a] == basin_[b]) continue;
      widest = std::max(widest, std::min(bottleneck_[a], bottleneck_[b]));
    }
  }
  for (const EdgeWay& way : ways) {
    const auto a = static_cast<std::size_t>(way.from), b = static_cast<std::size_t>(way.to);
    if (a < begin || a >= end || basin_[a] == basin_[b]) continue;
    widest = std::max(widest, std::min({way.gap, bottleneck_[a], bottleneck_[b]}));
  }
  return widest;
}

/// The open points that open points join to one of the seeds.
void Classifier::ReachThroughOpen(const std::vector<int>& seeds, const std::vector<EdgeWay>& ways,
                                  std::vector<bool>* reached) {
  reached->assign(open_.size(), false);
  stack_.clear();
  const auto visit = [&](int point) {
    const auto i = static_cast<std::size_t>(point);
    if (!open_[i] || (*reached)[i]) return;
    (*reached)[i] = true;
    stack_.push_back(point);
  };
  for (const int seed : seeds) visit(seed);
  while (!stack_.empty()) {
    const int point = stack_.back();
    stack_.pop_back();
    for (const int next : surface_->neighbours[static_cast<std::size_t>(point)]) visit(next);
    ForWaysFrom(point, ways, [&](int next, double) { visit(next); });
  }
}

void Classifier::Classify(const std::vector<double>& phi, double open_gap,
                          const std::vector<bool>& was_wet, Classification* classification) {
  const std::size_t num_points = surface_->nodes.size();
  if (phi.size() != num_points || (!was_wet.empty() && was_wet.size() != num_points)) {
    throw std::invalid_argument("Classify: one phi and one was_wet a point of the surface");
  }

  Classification& result = *classification;
  Flood(phi, result.edge_ways);
  result.bottleneck_gaps.clear();
  for (int cup = 0; cup < surface_->num_cups(); ++cup) {
    result.bottleneck_gaps.push_back(BottleneckGap(cup, result.edge_ways));
  }

  open_.resize(num_points);
  for (std::size_t i = 0; i < num_points; ++i) open_[i] = phi[i] > open_gap;
  ReachThroughOpen(surface_->border, result.edge_ways, &outside_);
  ReachThroughOpen(surface_->port, result.edge_ways, &inside_);

  result.wet.resize(num_points);
  for (std::size_t i = 0; i < num_points; ++i) {
    const bool trapped = open_[i] && !outside_[i] && !inside_[i];
    const bool keeps_suction = !was_wet.empty() && was_wet[i];
    result.wet[i] = trapped ? keeps_suction : basin_[i] == Basin::kPort;
  }

  for (std::size_t cup = 0; cup < result.bottleneck_gaps.size(); ++cup) {
    if (!(result.bottleneck_gaps[cup] > open_gap)) continue;  // port and border are not joined
    std::fill(inside_.begin() + surface_->first_points[cup],
              inside_.begin() + surface_->first_points[cup + 1], false);
  }
  result.zones.resize(num_points);
  for (std::size_t i = 0; i < num_points; ++i) {
    result.zones[i] = ZoneOf(surface_->neighbours[i], i, outside_, inside_);
  }
}

Classification Classify(const CavitySurface& surface, const std::vector<double>& phi,
                        double open_gap, const std::vector<bool>& was_wet,
                        std::vector<EdgeWay> edge_ways) {
  Classification result;
  result.edge_ways = std::move(edge_ways);
  Classifier(surface).Classify(phi, open_gap, was_wet, &result);
  return result;
}

}  // namespace vacuum_gripper_sim
