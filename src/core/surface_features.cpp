#include "vacuum_gripper_sim/core/surface_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <variant>

#include "vacuum_gripper_sim/core/triangle_mesh.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

constexpr double kSharpAngle = M_PI / 6.0;  // between the normals of neighbouring faces [rad]

/// A vertex whose sides' directions add up to less than this share of their number is a corner.
constexpr double kStraight = 0.95;

/// How many pieces of at most `spacing` a length has.
int PiecesOf(double length, double spacing) {
  return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9)));
}

/// Points strictly between the ends of an edge.
void AddInterior(const Vector3d& from, const Vector3d& to, const Vector3d& outward, double spacing,
                 std::vector<FeaturePoint>* points) {
  const int pieces = PiecesOf((to - from).norm(), spacing);
  for (int i = 1; i < pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    points->push_back({(1.0 - share) * from + share * to, outward});
  }
}

std::vector<FeaturePoint> FeaturesOf(const Plane&, double) { return {}; }
std::vector<FeaturePoint> FeaturesOf(const Sphere&, double) { return {}; }

std::vector<FeaturePoint> FeaturesOf(const Box& box, double spacing) {
  std::vector<FeaturePoint> points;
  const Vector3d half = 0.5 * box.size;
  for (int corner = 0; corner < 8; ++corner) {
    Vector3d sign;
    for (int axis = 0; axis < 3; ++axis) sign(axis) = (corner >> axis & 1) != 0 ? 1.0 : -1.0;
    const Vector3d p = half.cwiseProduct(sign);
    points.push_back({p, sign.normalized()});
    for (int axis = 0; axis < 3; ++axis) {
      if (sign(axis) > 0.0) continue;  // each edge from its lower end
      Vector3d end = p, outward = sign;
      end(axis) = half(axis);
      outward(axis) = 0.0;
      AddInterior(p, end, outward.normalized(), spacing, &points);
    }
  }
  return points;
}

std::vector<FeaturePoint> FeaturesOf(const Cylinder& cylinder, double spacing) {
  std::vector<FeaturePoint> points;
  // At least a hexagon, however small the cylinder is.
  const int pieces = std::max(6, PiecesOf(2.0 * M_PI * cylinder.radius, spacing));
  for (const double end : {-1.0, 1.0}) {
    for (int i = 0; i < pieces; ++i) {
      const double angle = 2.0 * M_PI * i / pieces;
      const Vector3d radial(std::cos(angle), std::sin(angle), 0.0);
      const Vector3d axial(0.0, 0.0, end);
      points.push_back({cylinder.radius * radial + 0.5 * cylinder.length * axial,
                        (radial + axial).normalized()});
    }
  }
  return points;
}

/// Keeps points apart that point the same way: a grid with cells as wide as the least distance.
class Thinning {
 public:
  explicit Thinning(double least) : least_(least) {}

  /// Takes a point, unless there is one near it already.
  void Add(const FeaturePoint& point) {
    const Cell cell = CellOf(point.p_S);
    for (int i = 0; i < 27; ++i) {
      const auto place =
          taken_.find({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1});
      if (place == taken_.end()) continue;
      for (const std::size_t other : place->second) {
        const bool near = (points_[other].p_S - point.p_S).norm() < least_;
        if (near && points_[other].outward_S.dot(point.outward_S) > kAlike) return;
      }
    }
    taken_[cell].push_back(points_.size());
    points_.push_back(point);
  }

  const std::vector<FeaturePoint>& points() const { return points_; }

 private:
  static constexpr double kAlike = 0.5;  // cosine; both edges of a thin plate stay
  using Cell = std::array<long, 3>;
  Cell CellOf(const Vector3d& p) const {
    return {std::lround(p.x() / least_), std::lround(p.y() / least_), std::lround(p.z() / least_)};
  }

  double least_;
  std::vector<FeaturePoint> points_;
  std::map<Cell, std::vector<std::size_t>> taken_;
};

/// Do two faces bulge along side k of triangle t, and by more than the sharp angle?
bool IsSharp(const TriangleMesh& mesh, int t, int k) {
  const int other = mesh.topology().neighbors(k, t);
  if (other == TriangleTopology::kNone) return true;
  const Vector3d n = mesh.normal(t), m = mesh.normal(other);
  if (n.isZero(0.0) || m.isZero(0.0) || n.dot(m) > std::cos(kSharpAngle)) return false;
  if (!mesh.shell_closed(mesh.shell(t))) return true;  // it bulges on one of its sides
  const Vector3d edge = mesh.vertices().col(mesh.triangles()((k + 1) % 3, t)) -
                        mesh.vertices().col(mesh.triangles()(k, t));
  return n.cross(m).dot(edge) > 0.0;
}

/// Halfway between the faces at side k; of a border, along the sheet and away from it.
Vector3d OutwardOfSide(const TriangleMesh& mesh, int t, int k) {
  const int other = mesh.topology().neighbors(k, t);
  if (other != TriangleTopology::kNone) {
    return (mesh.normal(t) + mesh.normal(other)).stableNormalized();
  }
  const Vector3d edge = mesh.vertices().col(mesh.triangles()((k + 1) % 3, t)) -
                        mesh.vertices().col(mesh.triangles()(k, t));
  return edge.cross(mesh.normal(t)).stableNormalized();
}

std::vector<FeaturePoint> FeaturesOf(const Mesh& shared, double spacing) {
  const TriangleMesh& mesh = *shared;
  struct SharpSide {
    int from, to;
    Vector3d outward;
  };
  struct SharpVertex {
    Vector3d sum{Vector3d::Zero()};  // of its sides' directions
    int num_sides{0};
  };
  std::vector<SharpSide> sides;
  std::map<int, SharpVertex> vertices;
  for (int t = 0; t < mesh.num_triangles(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int other = mesh.topology().neighbors(k, t);
      if ((other != TriangleTopology::kNone && other < t) || !IsSharp(mesh, t, k)) continue;
      const SharpSide side{mesh.triangles()(k, t), mesh.triangles()((k + 1) % 3, t),
                           OutwardOfSide(mesh, t, k)};
      for (const int end : {side.from, side.to}) {
        vertices[end].sum += side.outward;
        ++vertices[end].num_sides;
      }
      sides.push_back(side);
    }
  }
  Thinning thinning(0.5 * spacing);
  // Corners, where the sides' directions differ, before what merely lies along an edge.
  for (const bool corners : {true, false}) {
    for (const auto& [v, vertex] : vertices) {
      if ((vertex.sum.norm() < kStraight * vertex.num_sides) != corners) continue;
      thinning.Add({mesh.vertices().col(v), vertex.sum.stableNormalized()});
    }
  }
  std::vector<FeaturePoint> interior;
  for (const SharpSide& side : sides) {
    AddInterior(mesh.vertices().col(side.from), mesh.vertices().col(side.to), side.outward, spacing,
                &interior);
  }
  for (const FeaturePoint& point : interior) thinning.Add(point);
  return thinning.points();
}

}  // namespace

std::vector<FeaturePoint> SharpFeatures(const Shape& shape, double spacing) {
  if (!(spacing > 0.0)) {
    throw std::invalid_argument("spacing of sharp features = " + std::to_string(spacing) +
                                ", must be > 0 [m]");
  }
  return std::visit([&](const auto& kind) { return FeaturesOf(kind, spacing); }, shape);
}

}  // namespace vacuum_gripper_sim
