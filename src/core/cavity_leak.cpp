#include "vacuum_gripper_sim/core/cavity_leak.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vacuum_gripper_sim {
namespace {

/// Points further away than this leave roughness no part in the flow. [m]
constexpr double kNear = 1e-3;

const CupFaults& FaultsOf(std::size_t cup, const VacuumFaults& faults) {
  static const CupFaults kNone;
  return cup < faults.cups.size() ? faults.cups[cup] : kNone;
}

}  // namespace

CavityLeak::CavityLeak(const CupArray& cups, double open_gap, double reduced_modulus)
    : cups_(&cups), lip_(CavityOfCup(cups.cavities, 0), cups.rest_of_one, reduced_modulus) {
  contact_.tolerance = open_gap;
}

void CavityLeak::Measure(const ContactStage& stage, const RigidWorld& world,
                         const SuctionSolution& solution, const std::vector<bool>& wet,
                         const Eigen::Matrix3Xd& area_vectors, const VacuumFaults& faults,
                         std::vector<CupLeak>* leaks) {
  const CavitySurface& cavity = cups_->cavities;
  const auto num_cups = static_cast<std::size_t>(cups_->num_cups());
  const auto num_points = cavity.nodes.size() / num_cups;
  const bool touches_nothing = world.surfaces().empty();
  const bool some_are_porous =
      !faults.permeances.empty() ||
      std::any_of(world.surfaces().begin(), world.surfaces().end(),
                  [](const RigidSurface& surface) { return surface.permeance > 0.0; });
  contact_.gap.resize(num_points);
  contact_.normal_force.resize(num_points);
  contact_.roughness.resize(num_points);
  leaks->resize(num_cups);
  for (std::size_t cup = 0; cup < num_cups; ++cup) {
    CupLeak& leak = (*leaks)[cup];
    leak.porosity = 0.0;
    const auto first = static_cast<std::size_t>(cavity.first_points[cup]);
    for (std::size_t i = 0; i < num_points; ++i) {
      const int node = cavity.nodes[first + i];
      contact_.gap[i] = solution.contact.distance[static_cast<std::size_t>(node)];
      contact_.normal_force[i] = solution.contact.on_objects(node);
      contact_.roughness[i] = 0.0;
      const bool is_near = contact_.gap[i] < kNear;
      if (touches_nothing || !(is_near || some_are_porous)) continue;
      const int nearest = stage.NearestSurface(node);
      const RigidSurface& surface = world.surfaces()[static_cast<std::size_t>(nearest)];
      contact_.roughness[i] = surface.roughness;
      if (!some_are_porous || !wet[first + i]) continue;
      const auto object = static_cast<std::size_t>(world.ObjectOf(nearest));
      const double added = object < faults.permeances.size() ? faults.permeances[object] : 0.0;
      const double permeance = surface.permeance + added;
      if (permeance == 0.0) continue;
      // What a point's area looks like from the surface; walls that face each other cancel.
      const Eigen::Vector3d area_W = area_vectors.col(static_cast<Eigen::Index>(first + i));
      leak.porosity +=
          permeance * area_W.dot(Distance(surface, solution.contact.x_W.col(node)).normal);
    }
    leak.porosity = std::max(leak.porosity, 0.0);
    const CupFaults& of_cup = FaultsOf(cup, faults);
    x_W_ = solution.contact.x_W.middleCols(cups_->FirstNode(cup), cups_->nodes_per_cup);
    lip_.Measure(x_W_, contact_, of_cup.dirt, &leak.lip);
    leak.hole_area =
        of_cup.torn_area + HoleArea(static_cast<int>(cup), world, solution.contact.x_W, wet);
  }
}

/// Of the holes in surfaces that a cup covers. [m^2]
double CavityLeak::HoleArea(int cup, const RigidWorld& world, const Eigen::Matrix3Xd& x_W,
                            const std::vector<bool>& wet) const {
  const CavitySurface& cavity = cups_->cavities;
  const auto k = static_cast<std::size_t>(cup);
  double area = 0.0;
  for (const RigidSurface& surface : world.surfaces()) {
    for (const SurfaceHole& hole : surface.holes) {
      const Eigen::Vector3d p_W = surface.X_FS * hole.p_S;
      double nearest = std::numeric_limits<double>::infinity();
      bool covered = false;
      for (int i = cavity.first_points[k]; i < cavity.first_points[k + 1]; ++i) {
        const auto point = static_cast<std::size_t>(i);
        const double distance = (x_W.col(cavity.nodes[point]) - p_W).norm();
        if (distance >= nearest) continue;
        nearest = distance;
        covered = wet[point];
      }
      if (covered && nearest < lip_.meridians().radius) area += hole.area;
    }
  }
  return area;
}

}  // namespace vacuum_gripper_sim
