#include "vacuum_gripper_sim/core/cavity_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

using Eigen::MatrixXi;
using Eigen::Vector3d;

// Two points as near to the axis as this are equally near. [m]
constexpr double kPortTolerance = 1e-9;

using Edge = std::pair<int, int>;

std::size_t Index(const int i) { return static_cast<std::size_t>(i); }

// Disjoint sets of the numbers 0 .. n-1.
class DisjointSets {
 public:
  explicit DisjointSets(const int n) : parent_(Index(n)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int Find(int i) {
    while (parent_[Index(i)] != i) i = parent_[Index(i)] = parent_[Index(parent_[Index(i)])];
    return i;
  }

  void Join(const int i, const int j) { parent_[Index(Find(i))] = Find(j); }

 private:
  std::vector<int> parent_;
};

class Builder {
 public:
  explicit Builder(const TetMesh& mesh) : mesh_(mesh) {}

  CavitySurface Build() {
    NumberPoints();
    SplitFaces();
    FindEdges();
    CheckManifold();
    FindBorder();
    FindPort();
    return std::move(surface_);
  }

 private:
  template <typename... Parts>
  [[noreturn]] void Fail(const Parts&... parts) const {
    std::ostringstream message;
    message << mesh_.source << ": cavity surface: ";
    (message << ... << parts);
    throw std::invalid_argument(message.str());
  }

  Vector3d Position(const int point) const { return mesh_.nodes.col(surface_.nodes[Index(point)]); }

  std::string Name(const int point) const {
    const Vector3d p = Position(point);
    std::ostringstream text;
    text << "node " << surface_.nodes[Index(point)] << " (from 0) at (" << p.x() << ", " << p.y()
         << ", " << p.z() << ") m";
    return text.str();
  }

  std::string Name(const Edge& edge) const {
    return "the edge from " + Name(edge.first) + " to " + Name(edge.second);
  }

  void NumberPoints() {
    const MatrixXi& faces = mesh_.cavity_faces;
    if (faces.cols() == 0) Fail("it has no faces, must have at least one");
    surface_.nodes.assign(faces.data(), faces.data() + faces.size());
    std::sort(surface_.nodes.begin(), surface_.nodes.end());
    surface_.nodes.erase(std::unique(surface_.nodes.begin(), surface_.nodes.end()),
                         surface_.nodes.end());
    surface_.first_points = {0, surface_.num_points()};
  }

  int Point(const int node) const {
    return static_cast<int>(std::lower_bound(surface_.nodes.begin(), surface_.nodes.end(), node) -
                            surface_.nodes.begin());
  }

  // Faces point out of the material; triangles point into it, so they are wound the other way.
  void SplitFaces() {
    static constexpr int kLinear[1][3] = {{0, 2, 1}};
    static constexpr int kQuadratic[4][3] = {{0, 5, 3}, {3, 4, 1}, {5, 2, 4}, {3, 5, 4}};
    const MatrixXi& faces = mesh_.cavity_faces;
    const bool quadratic = faces.rows() == 6;
    const int parts = quadratic ? 4 : 1;
    surface_.triangles.resize(3, parts * faces.cols());
    for (int f = 0; f < faces.cols(); ++f) {
      for (int part = 0; part < parts; ++part) {
        const int* corners = quadratic ? kQuadratic[part] : kLinear[0];
        for (int k = 0; k < 3; ++k) {
          surface_.triangles(k, parts * f + part) = Point(faces(corners[k], f));
        }
      }
    }
  }

  // Edges in the direction in which their triangle runs through them.
  void FindEdges() {
    surface_.neighbours.resize(surface_.nodes.size());
    for (int t = 0; t < surface_.triangles.cols(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const Edge edge(surface_.triangles(k, t), surface_.triangles((k + 1) % 3, t));
        if (!triangle_of_.emplace(edge, t).second) {
          Fail(Name(edge), " belongs to more than two triangles, must belong to one or two");
        }
        surface_.neighbours[Index(edge.first)].push_back(edge.second);
        surface_.neighbours[Index(edge.second)].push_back(edge.first);
      }
    }
    for (std::vector<int>& points : surface_.neighbours) {
      std::sort(points.begin(), points.end());
      points.erase(std::unique(points.begin(), points.end()), points.end());
    }
  }

  // One piece, and one fan of triangles around every point.
  void CheckManifold() const {
    const int num_triangles = static_cast<int>(surface_.triangles.cols());
    DisjointSets pieces(surface_.num_points());
    DisjointSets fans(3 * num_triangles);  // of the triangles' corners
    const auto corner = [this](const int t, const int point) {
      int k = 0;
      while (surface_.triangles(k, t) != point) ++k;
      return 3 * t + k;
    };
    for (const auto& [edge, t] : triangle_of_) {
      pieces.Join(edge.first, edge.second);
      const auto twin = triangle_of_.find({edge.second, edge.first});
      if (twin == triangle_of_.end()) continue;
      fans.Join(corner(t, edge.first), corner(twin->second, edge.first));
      fans.Join(corner(t, edge.second), corner(twin->second, edge.second));
    }
    for (int point = 1; point < surface_.num_points(); ++point) {
      if (pieces.Find(point) != pieces.Find(0)) {
        Fail("it is in several pieces, must be one: no edges lead from ", Name(0), " to ",
             Name(point));
      }
    }
    std::vector<int> fan_of(surface_.nodes.size(), -1);
    for (int c = 0; c < 3 * num_triangles; ++c) {
      const int point = surface_.triangles(c % 3, c / 3);
      int& fan = fan_of[Index(point)];
      if (fan < 0) fan = fans.Find(c);
      if (fan != fans.Find(c)) {
        Fail("two parts of it touch in ", Name(point), " alone, must share an edge");
      }
    }
  }

  void FindBorder() {
    std::map<int, int> next;  // along the border; one a point, for every point has one fan
    for (const auto& [edge, t] : triangle_of_) {
      if (triangle_of_.count({edge.second, edge.first}) == 0) next.insert(edge);
    }
    if (next.empty()) Fail("it is closed, must have a border (the rim)");
    int point = next.begin()->first;
    do {
      surface_.border.push_back(point);
      point = next.at(point);
    } while (point != surface_.border.front());
    std::sort(surface_.border.begin(), surface_.border.end());
    for (const auto& edge : next) {
      if (!std::binary_search(surface_.border.begin(), surface_.border.end(), edge.first)) {
        Fail("it has several borders, must have one (the rim): ", Name(*next.begin()), " and ",
             Name(edge), " are on different ones");
      }
    }
  }

  void FindPort() {
    const auto radius = [this](const int i) { return Position(i).head<2>().norm(); };
    double nearest = radius(0);
    for (int i = 1; i < surface_.num_points(); ++i) nearest = std::min(nearest, radius(i));
    int port = -1;
    for (int i = 0; i < surface_.num_points(); ++i) {
      if (radius(i) > nearest + kPortTolerance) continue;
      if (port < 0 || Position(i).z() > Position(port).z()) port = i;
    }
    surface_.port = {port};
  }

  const TetMesh& mesh_;
  CavitySurface surface_;
  std::map<Edge, int> triangle_of_;
};

}  // namespace

CavitySurface MakeCavitySurface(const TetMesh& mesh) { return Builder(mesh).Build(); }

void PointAreaVectors(const CavitySurface& surface, const Eigen::Matrix3Xd& x_W,
                      Eigen::Matrix3Xd* areas) {
  if (!surface.nodes.empty() && surface.nodes.back() >= x_W.cols()) {
    std::ostringstream message;
    message << "PointAreaVectors: x_W has " << x_W.cols() << " nodes, must have more than "
            << surface.nodes.back();
    throw std::invalid_argument(message.str());
  }
  areas->setZero(3, surface.num_points());
  for (int t = 0; t < surface.triangles.cols(); ++t) {
    const auto triangle = surface.triangles.col(t);
    const Vector3d a = x_W.col(surface.nodes[Index(triangle(0))]);
    const Vector3d b = x_W.col(surface.nodes[Index(triangle(1))]);
    const Vector3d c = x_W.col(surface.nodes[Index(triangle(2))]);
    const Vector3d third = (b - a).cross(c - a) / 6.0;
    for (int k = 0; k < 3; ++k) areas->col(triangle(k)) += third;
  }
}

Eigen::Matrix3Xd PointAreaVectors(const CavitySurface& surface, const Eigen::Matrix3Xd& x_W) {
  Eigen::Matrix3Xd areas;
  PointAreaVectors(surface, x_W, &areas);
  return areas;
}

}  // namespace vacuum_gripper_sim
