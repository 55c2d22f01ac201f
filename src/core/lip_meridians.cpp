#include "vacuum_gripper_sim/core/lip_meridians.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "vacuum_gripper_sim/core/triangle_geometry.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;
using Crossing = LipMeridians::Crossing;

constexpr double kStep = 2.0 * M_PI / LipMeridians::kNumber;  // rad
/// Of the border's mean radius: where meridians begin, and from where on they are kept.
constexpr double kPort = 0.25, kInner = 0.1;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

class Builder {
 public:
  Builder(const CavitySurface& surface, const Eigen::Matrix3Xd& rest)
      : surface_(surface),
        topology_(surface.triangles, surface.num_points()),
        rest_(3, surface.num_points()) {
    for (int i = 0; i < surface.num_points(); ++i) rest_.col(i) = rest.col(surface.nodes[Index(i)]);
  }

  LipMeridians Build() {
    for (const int point : surface_.border) meridians_.radius += rest_.col(point).head<2>().norm();
    meridians_.radius /= static_cast<double>(surface_.border.size());
    for (int k = 0; k < LipMeridians::kNumber; ++k) {
      Follow(k);
    }
    for (int k = 0; k < LipMeridians::kNumber; ++k) MatchNext(k);
    return std::move(meridians_);
  }

 private:
  /// On which side of the meridian's plane; points in the plane count as beyond it.
  bool IsBeyond(int point) const { return across_(point) >= 0.0; }
  bool Crosses(int t, int side) const {
    return IsBeyond(surface_.triangles(side, t)) != IsBeyond(surface_.triangles((side + 1) % 3, t));
  }
  Crossing CrossingOf(int t, int side) const {
    Crossing crossing;
    crossing.a = surface_.triangles(side, t);
    crossing.b = surface_.triangles((side + 1) % 3, t);
    crossing.t = across_(crossing.a) / (across_(crossing.a) - across_(crossing.b));
    return crossing;
  }
  Vector3d Position(const Crossing& crossing) const {
    return (1.0 - crossing.t) * rest_.col(crossing.a) + crossing.t * rest_.col(crossing.b);
  }
  /// Along the half plane, from the axis. [m]
  double Reach(const Crossing& crossing) const {
    return (1.0 - crossing.t) * along_(crossing.a) + crossing.t * along_(crossing.b);
  }

  /// From the border inwards; a triangle that is entered through one side is left through another.
  void Follow(int k) {
    const double azimuth = LipMeridians::Azimuth(k);
    const Eigen::RowVector2d direction(std::cos(azimuth), -std::sin(azimuth));
    along_ = direction * rest_.topRows<2>();
    across_ = Eigen::RowVector2d(-direction.y(), direction.x()) * rest_.topRows<2>();
    std::vector<Crossing>& chain = meridians_.crossings;
    const int first = static_cast<int>(chain.size());
    auto [t, entry] = FindStart(azimuth);
    chain.push_back(CrossingOf(t, entry));
    int num_counted = 0;
    while (true) {
      if (Reach(chain.back()) >= kPort * meridians_.radius) {
        num_counted = static_cast<int>(chain.size()) - first;
      }
      int exit = (entry + 1) % 3;
      if (!Crosses(t, exit)) exit = (entry + 2) % 3;
      const Crossing crossing = CrossingOf(t, exit);
      if (Reach(crossing) < kInner * meridians_.radius) break;
      chain.push_back(crossing);
      const int from = t;
      t = topology_.neighbors(exit, from);
      if (t == TriangleTopology::kNone) Fail(azimuth);  // out over the border again
      entry = 0;
      while (topology_.neighbors(entry, t) != from || !Crosses(t, entry)) ++entry;
    }
    const int end = static_cast<int>(chain.size());
    if (num_counted < 2) Fail(azimuth);
    std::reverse(chain.begin() + first, chain.end());
    meridians_.chains.push_back({first, end - num_counted, end});
  }

  struct Side {
    int t, side;
  };
  Side FindStart(double azimuth) const {
    Side start{TriangleTopology::kNone, 0};
    for (int t = 0; t < surface_.triangles.cols(); ++t) {
      for (int side = 0; side < 3; ++side) {
        if (topology_.neighbors(side, t) != TriangleTopology::kNone || !Crosses(t, side)) continue;
        if (Reach(CrossingOf(t, side)) <= 0.0) continue;
        if (start.t != TriangleTopology::kNone) Fail(azimuth);
        start = {t, side};
      }
    }
    if (start.t == TriangleTopology::kNone) Fail(azimuth);
    return start;
  }

  [[noreturn]] static void Fail(double azimuth) {
    std::ostringstream message;
    message << "cavity surface: no single way leads from its border to the axis x = y = 0 at "
            << azimuth << " rad; the border must go once round the axis, and the surface over it";
    throw std::invalid_argument(message.str());
  }

  /// The nearest place on the next meridian once that is turned onto this one.
  void MatchNext(int k) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(kStep, Vector3d::UnitZ()).toRotationMatrix();
    const LipMeridians::Chain& chain = meridians_.chains[Index(k)];
    const LipMeridians::Chain& beside = meridians_.chains[Index((k + 1) % LipMeridians::kNumber)];
    for (int i = chain.begin; i < chain.end; ++i) {
      Crossing& crossing = meridians_.crossings[Index(i)];
      const Vector3d here = Position(crossing);
      double nearest = std::numeric_limits<double>::infinity();
      for (int j = beside.inner; j + 1 < beside.end; ++j) {
        const Vector3d from = turn * Position(meridians_.crossings[Index(j)]);
        const Vector3d way = turn * Position(meridians_.crossings[Index(j) + 1]) - from;
        const double length2 = std::max(way.squaredNorm(), std::numeric_limits<double>::min());
        const double t = std::min(1.0, std::max(0.0, way.dot(here - from) / length2));
        const double distance = (from + t * way - here).norm();
        if (distance >= nearest) continue;
        nearest = distance;
        crossing.beside = j;
        crossing.beside_t = t;
      }
    }
  }

  const CavitySurface& surface_;
  TriangleTopology topology_;
  Eigen::Matrix3Xd rest_;              // of the points [m]
  Eigen::RowVectorXd along_, across_;  // of the points, in the current plane and off it [m]
  LipMeridians meridians_;
};

}  // namespace

double LipMeridians::Azimuth(int meridian) { return (meridian + 0.5) * kStep; }

LipMeridians MakeLipMeridians(const CavitySurface& surface, const Eigen::Matrix3Xd& rest) {
  return Builder(surface, rest).Build();
}

}  // namespace vacuum_gripper_sim
