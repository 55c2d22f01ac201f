#include "vacuum_gripper_sim/core/lip_leak.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "vacuum_gripper_sim/core/gas_flow.h"
#include "vacuum_gripper_sim/core/rough_contact.h"

namespace vacuum_gripper_sim {
namespace {

constexpr int kSectors = LipMeridians::kNumber;
constexpr double kTurn = 2.0 * M_PI;
constexpr double kStep = kTurn / kSectors;  // rad
/// Half the width of the hat that spreads forces, in edges of the border.
constexpr double kSpread = 2.0;
/// Of a meridian's mean piece: what at least touches where anything does.
constexpr double kSmallestTouch = 0.25;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

int WrapSector(int k) { return ((k % kSectors) + kSectors) % kSectors; }

/// Of ds / g^3 over a unit of length, where g runs linearly from g_0 to g_1. [1/m^3]
double Resistance(double g_0, double g_1) { return 0.5 * (g_0 + g_1) / (g_0 * g_0 * g_1 * g_1); }

/// The part of a piece that touches, where the gap beyond the tolerance runs from gap_0 to gap_1.
double TouchingPart(double gap_0, double gap_1) {
  const double low = std::min(gap_0, gap_1), high = std::max(gap_0, gap_1);
  if (high <= 0.0) return 1.0;
  return low >= 0.0 ? 0.0 : low / (low - high);
}

/// Mean distance of neighbouring border points that an edge joins. [m]
double MeanBorderEdge(const CavitySurface& surface, const Eigen::Matrix3Xd& rest) {
  double sum = 0.0;
  for (const int a : surface.border) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const int b : surface.neighbours[Index(a)]) {
      if (!std::binary_search(surface.border.begin(), surface.border.end(), b)) continue;
      const double length =
          (rest.col(surface.nodes[Index(a)]) - rest.col(surface.nodes[Index(b)])).norm();
      nearest = std::min(nearest, length);
    }
    sum += nearest;
  }
  return sum / static_cast<double>(surface.border.size());
}

}  // namespace

double LeakPaths::Throughput(double p_from, double p_to) const {
  const double slit = std::abs(SlitThroughput(1.0, p_from, p_to));        // of a unit of shape
  const double orifice = std::abs(OrificeThroughput(1.0, p_from, p_to));  // of a unit of area
  double sum = 0.0;
  for (const LeakPath& path : sectors) sum += std::min(slit * path.shape, orifice * path.area);
  return std::copysign(sum, p_from - p_to);
}

double LeakPaths::area() const {
  double sum = 0.0;
  for (const LeakPath& path : sectors) sum += path.area;
  return sum;
}

double LeakPaths::EquivalentArea(double p_from, double p_to) const {
  const double orifice = OrificeThroughput(1.0, p_from, p_to);
  return orifice == 0.0 ? 0.0 : Throughput(p_from, p_to) / orifice;
}

LipLeak::LipLeak(const CavitySurface& surface, const Eigen::Matrix3Xd& rest, double reduced_modulus)
    : meridians_(MakeLipMeridians(surface, rest)),
      nodes_(surface.nodes),
      reduced_modulus_(reduced_modulus),
      widest_gap_(0.5 * meridians_.radius),
      positions_W_(3, static_cast<Eigen::Index>(meridians_.crossings.size())),
      stations_(meridians_.crossings.size()),
      binned_(kSectors),
      force_(kSectors) {
  FindSmallestTouch(rest);
  PrepareSpread(surface, rest);
}

void LipLeak::FindSmallestTouch(const Eigen::Matrix3Xd& rest) {
  LipContact closed;
  for (std::vector<double>* values : {&closed.gap, &closed.normal_force, &closed.roughness}) {
    values->assign(nodes_.size(), 0.0);
  }
  PlaceStations(rest, closed);
  double length = 0.0;
  int num_pieces = 0;
  for (const LipMeridians::Chain& chain : meridians_.chains) {
    for (int i = chain.begin; i + 1 < chain.end; ++i) length += stations_[Index(i)].length;
    num_pieces += chain.end - chain.begin - 1;
  }
  const double mean_piece = length / num_pieces;
  smallest_touch_ = kSmallestTouch * mean_piece * kStep * meridians_.radius;
}

void LipLeak::PrepareSpread(const CavitySurface& surface, const Eigen::Matrix3Xd& rest) {
  bins_.reserve(nodes_.size());
  for (const int node : nodes_) {
    const double azimuth = std::atan2(-rest(1, node), rest(0, node));
    const double place = azimuth / kStep - 0.5;
    const double bin = std::floor(place);
    bins_.push_back({WrapSector(static_cast<int>(bin)), place - bin});
  }
  const double half_width =  // in sectors
      std::min(0.5 * kSectors, kSpread * MeanBorderEdge(surface, rest) / meridians_.radius / kStep);
  double sum = 0.0;
  for (int k = 0; k == 0 || k < half_width; ++k) {
    hat_.push_back(1.0 - k / std::max(half_width, 1.0));
    sum += (k == 0 ? 1.0 : 2.0) * hat_.back();
  }
  for (double& weight : hat_) weight /= sum;
}

void LipLeak::Measure(const Eigen::Matrix3Xd& x_W, const LipContact& contact,
                      const std::vector<DirtSector>& dirt, LeakPaths* paths) {
  if (contact.gap.size() != nodes_.size() || contact.normal_force.size() != nodes_.size() ||
      contact.roughness.size() != nodes_.size()) {
    throw std::invalid_argument(
        "LipLeak: one gap, normal_force and roughness a point of the cavity surface");
  }
  PlaceStations(x_W, contact);
  SpreadForces(contact.normal_force);
  paths->sectors.resize(kSectors);
  for (int k = 0; k < kSectors; ++k) {
    // In proportion to the roughness, which may change along the meridian.
    const double rough_gap = HydraulicGap(1.0, ContactPressure(k), reduced_modulus_);
    const Cover cover = CoverOf(k, dirt);
    LeakPath path;
    if (cover.part < 1.0) path = Path(k, rough_gap, 0.0);
    if (cover.part > 0.0) {
      const LeakPath propped = Path(k, rough_gap, cover.gap);
      path.shape += cover.part * (propped.shape - path.shape);
      path.area += cover.part * (propped.area - path.area);
    }
    paths->sectors[Index(k)] = path;
  }
}

void LipLeak::PlaceStations(const Eigen::Matrix3Xd& x_W, const LipContact& contact) {
  const auto gap_of = [&](int point) { return std::min(contact.gap[Index(point)], widest_gap_); };
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const LipMeridians::Crossing& at = meridians_.crossings[i];
    const double s = 1.0 - at.t;
    positions_W_.col(static_cast<Eigen::Index>(i)) =
        s * x_W.col(nodes_[Index(at.a)]) + at.t * x_W.col(nodes_[Index(at.b)]);
    stations_[i].gap = s * gap_of(at.a) + at.t * gap_of(at.b) - contact.tolerance;
    stations_[i].roughness =
        s * contact.roughness[Index(at.a)] + at.t * contact.roughness[Index(at.b)];
  }
  for (int k = 0; k < kSectors; ++k) {
    const LipMeridians::Chain& chain = meridians_.chains[Index(k)];
    const int last = chain.end - 1;
    for (int i = chain.begin; i <= last; ++i) {
      const LipMeridians::Crossing& at = meridians_.crossings[Index(i)];
      Station& station = stations_[Index(i)];
      station.width = (positions_W_.col(i) - (1.0 - at.beside_t) * positions_W_.col(at.beside) -
                       at.beside_t * positions_W_.col(at.beside + 1))
                          .norm();
      station.length = i < last ? (positions_W_.col(i + 1) - positions_W_.col(i)).norm() : 0.0;
    }
  }
}

void LipLeak::SpreadForces(const std::vector<double>& normal_force) {
  std::fill(binned_.begin(), binned_.end(), 0.0);
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    if (normal_force[i] == 0.0) continue;
    const Bin& at = bins_[i];
    binned_[Index(at.bin)] += (1.0 - at.fraction) * normal_force[i];
    binned_[Index(WrapSector(at.bin + 1))] += at.fraction * normal_force[i];
  }
  std::fill(force_.begin(), force_.end(), 0.0);
  for (int k = 0; k < kSectors; ++k) {
    if (binned_[Index(k)] == 0.0) continue;
    force_[Index(k)] += hat_[0] * binned_[Index(k)];
    for (int i = 1; i < static_cast<int>(hat_.size()); ++i) {
      force_[Index(WrapSector(k + i))] += hat_[Index(i)] * binned_[Index(k)];
      force_[Index(WrapSector(k - i))] += hat_[Index(i)] * binned_[Index(k)];
    }
  }
}

/// Nominal, of what touches in a sector. [Pa]
double LipLeak::ContactPressure(int meridian) const {
  double area = 0.0;
  const LipMeridians::Chain& chain = meridians_.chains[Index(meridian)];
  for (int i = chain.begin; i + 1 < chain.end; ++i) {
    const Station& from = stations_[Index(i)];
    const Station& to = stations_[Index(i) + 1];
    area += TouchingPart(from.gap, to.gap) * from.length * 0.5 * (from.width + to.width);
  }
  return force_[Index(meridian)] / std::max(area, smallest_touch_);
}

/// @param rough_gap Of a roughness of 1. @param dirt_gap [m]
LeakPath LipLeak::Path(int meridian, double rough_gap, double dirt_gap) const {
  const LipMeridians::Chain& chain = meridians_.chains[Index(meridian)];
  const auto floor_of = [&](const Station& at) { return rough_gap * at.roughness + dirt_gap; };
  LeakPath path;
  path.area = std::numeric_limits<double>::infinity();
  double resistance = 0.0;  // 1/m^3
  for (int i = chain.begin; i < chain.end; ++i) {
    const Station& from = stations_[Index(i)];
    const double floor_from = floor_of(from);
    const double g_from = floor_from + std::max(0.0, from.gap);
    if (g_from <= 0.0) return {};  // smooth, and touching
    path.area = std::min(path.area, from.width * g_from);
    if (i + 1 == chain.end) break;

    const Station& to = stations_[Index(i) + 1];
    const double floor_to = floor_of(to);
    const double g_to = floor_to + std::max(0.0, to.gap);
    if (g_to <= 0.0) return {};
    const double touching = TouchingPart(from.gap, to.gap);
    double along = 0.0;  // 1/m^3
    if (touching == 0.0 || touching == 1.0) {
      along = Resistance(g_from, g_to);
    } else {  // the gap has a bend where the lip lets go
      const double part = from.gap < to.gap ? touching : 1.0 - touching;
      const double g_bend = (1.0 - part) * floor_from + part * floor_to;
      along = part * Resistance(g_from, g_bend) + (1.0 - part) * Resistance(g_bend, g_to);
    }
    resistance += from.length * along / (0.5 * (from.width + to.width));
  }
  path.shape = 1.0 / resistance;
  return path;
}

LipLeak::Cover LipLeak::CoverOf(int meridian, const std::vector<DirtSector>& dirt) {
  Cover cover;
  for (const DirtSector& sector : dirt) {
    if (sector.gap <= cover.gap) continue;
    const double off =
        std::abs(std::remainder(LipMeridians::Azimuth(meridian) - sector.azimuth, kTurn));
    // The dirt's half turn that is nearer; one that goes all round covers all.
    const double reach = 0.5 * sector.width - off + 0.5 * kStep;
    const double part = std::min({1.0, reach / kStep, sector.width / kStep});
    if (sector.width >= kTurn) {
      cover = {1.0, sector.gap};
    } else if (part > 0.0) {
      cover = {part, sector.gap};
    }
  }
  return cover;
}

}  // namespace vacuum_gripper_sim
