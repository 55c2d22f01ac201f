#include "vacuum_gripper_sim/core/mesh_repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Matrix3Xi;
using Eigen::Vector3d;

constexpr double kSamePlace = 1e-7;   // of the diagonal
constexpr double kFlatHeight = 1e-6;  // of a triangle's longest side: single precision's noise
constexpr int kNone = -1;

std::size_t Index(Eigen::Index i) { return static_cast<std::size_t>(i); }

/// A triangle's side: its ends ascending, whether it runs from the lower to the higher one.
struct Side {
  std::pair<int, int> ends;
  int triangle;
  bool upward;
};

class Repair {
 public:
  Repair(const Matrix3Xd& vertices, const Matrix3Xi& triangles) {
    mesh_.vertices = vertices;
    mesh_.triangles = triangles;
  }

  RepairedTriangles Run() {
    if (mesh_.triangles.cols() == 0) return std::move(mesh_);
    MergeVertices();
    DropTriangles();
    MarkFlat();
    FindSides();
    WindAlike();
    FindShells();
    TurnInsideOutShells();
    return std::move(mesh_);
  }

 private:
  int num_triangles() const { return static_cast<int>(mesh_.triangles.cols()); }
  Vector3d Corner(int t, int k) const { return mesh_.vertices.col(mesh_.triangles(k, t)); }
  Vector3d Area(int t) const {
    return 0.5 * (Corner(t, 1) - Corner(t, 0)).cross(Corner(t, 2) - Corner(t, 0));
  }

  /// Along a direction in which regular meshes have few vertices side by side, those that can be in
  /// the same place are next to each other.
  void MergeVertices() {
    const Matrix3Xd& old = mesh_.vertices;
    const Vector3d direction(0.5417, 0.3093, 0.7816);
    const double tolerance =
        kSamePlace * (old.rowwise().maxCoeff() - old.rowwise().minCoeff()).norm();
    const Eigen::VectorXd along = old.transpose() * direction;
    std::vector<int> order(Index(old.cols()));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return std::make_pair(along(a), a) < std::make_pair(along(b), b);
    });
    std::vector<int> kept;  // old indices, in that order
    std::vector<int> number(order.size());
    std::size_t window = 0;
    for (const int v : order) {
      while (window < kept.size() && along(kept[window]) < along(v) - tolerance) ++window;
      const auto place = std::find_if(
          kept.begin() + static_cast<std::ptrdiff_t>(window), kept.end(),
          [&](int other) { return (old.col(other) - old.col(v)).norm() <= tolerance; });
      number[Index(v)] = static_cast<int>(place - kept.begin());
      if (place == kept.end()) kept.push_back(v);
    }
    Matrix3Xd merged(3, static_cast<Eigen::Index>(kept.size()));
    for (Eigen::Index v = 0; v < merged.cols(); ++v) merged.col(v) = old.col(kept[Index(v)]);
    mesh_.merged_vertices = static_cast<int>(old.cols() - merged.cols());
    mesh_.vertices = std::move(merged);
    mesh_.triangles = mesh_.triangles.unaryExpr([&](int v) { return number[Index(v)]; }).eval();
  }

  void DropTriangles() {
    std::map<std::array<int, 3>, int> seen;
    Eigen::Index count = 0;
    for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) {
      std::array<int, 3> corners{
          {mesh_.triangles(0, t), mesh_.triangles(1, t), mesh_.triangles(2, t)}};
      std::sort(corners.begin(), corners.end());
      if (corners[0] == corners[1] || corners[1] == corners[2]) continue;
      if (!seen.emplace(corners, 0).second) continue;
      mesh_.triangles.col(count++) = mesh_.triangles.col(t).eval();
    }
    mesh_.dropped_triangles = static_cast<int>(mesh_.triangles.cols() - count);
    mesh_.triangles.conservativeResize(3, count);
  }

  void MarkFlat() {
    mesh_.flat.assign(Index(num_triangles()), false);
    for (int t = 0; t < num_triangles(); ++t) {
      double longest = 0.0;
      for (int k = 0; k < 3; ++k) {
        longest = std::max(longest, (Corner(t, (k + 1) % 3) - Corner(t, k)).squaredNorm());
      }
      mesh_.flat[Index(t)] = 2.0 * Area(t).norm() <= kFlatHeight * longest;
    }
  }

  void FindSides() {
    for (int t = 0; t < num_triangles(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int from = mesh_.triangles(k, t), to = mesh_.triangles((k + 1) % 3, t);
        sides_.push_back({{std::min(from, to), std::max(from, to)}, t, from < to});
      }
    }
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
      return std::make_pair(a.ends, a.triangle) < std::make_pair(b.ends, b.triangle);
    });
  }

  /// Calls visit(begin, end) for all triangles at a side.
  template <typename Visitor>
  void ForEachEdge(const Visitor& visit) {
    for (auto begin = sides_.begin(); begin != sides_.end();) {
      const auto end = std::find_if(begin, sides_.end(),
                                    [&](const Side& side) { return side.ends != begin->ends; });
      visit(begin, end);
      begin = end;
    }
  }

  void WindAlike() {
    struct Neighbor {
      int triangle;
      bool alike;  // the side is run through in opposite directions
    };
    std::vector<std::vector<Neighbor>> neighbors(Index(num_triangles()));
    ForEachEdge([&](auto begin, auto end) {
      if (end - begin != 2) return;
      const Side &a = begin[0], &b = begin[1];
      neighbors[Index(a.triangle)].push_back({b.triangle, a.upward != b.upward});
      neighbors[Index(b.triangle)].push_back({a.triangle, a.upward != b.upward});
    });
    turn_.assign(Index(num_triangles()), false);
    std::vector<bool> reached(turn_.size(), false);
    for (int seed = 0; seed < num_triangles(); ++seed) {
      if (reached[Index(seed)]) continue;
      std::vector<int> patch{seed};
      reached[Index(seed)] = true;
      double balance = 0.0;  // area that keeps its winding less that which is turned
      for (std::size_t i = 0; i < patch.size(); ++i) {
        const std::size_t t = Index(patch[i]);
        balance += (turn_[t] ? -1.0 : 1.0) * Area(patch[i]).norm();
        for (const Neighbor& neighbor : neighbors[t]) {
          if (reached[Index(neighbor.triangle)]) continue;
          reached[Index(neighbor.triangle)] = true;
          turn_[Index(neighbor.triangle)] = turn_[t] == neighbor.alike;
          patch.push_back(neighbor.triangle);
        }
      }
      if (balance >= 0.0) continue;
      for (const int t : patch) turn_[Index(t)] = !turn_[Index(t)];
    }
    for (int t = 0; t < num_triangles(); ++t) {
      if (turn_[Index(t)]) Turn(t);
    }
    for (Side& side : sides_) side.upward = side.upward != turn_[Index(side.triangle)];
  }

  void Turn(int t) {
    std::swap(mesh_.triangles(1, t), mesh_.triangles(2, t));
    ++mesh_.turned_triangles;
  }

  int Root(int t) {
    while (parent_[Index(t)] != t) t = parent_[Index(t)] = parent_[Index(parent_[Index(t)])];
    return t;
  }

  void FindShells() {
    parent_.resize(Index(num_triangles()));
    std::iota(parent_.begin(), parent_.end(), 0);
    ForEachEdge([&](auto begin, auto end) {
      for (auto side = begin; side != end; ++side) {
        const int a = Root(begin->triangle), b = Root(side->triangle);
        parent_[Index(std::max(a, b))] = std::min(a, b);
      }
    });
    std::vector<int> number(parent_.size(), kNone);
    for (int t = 0; t < num_triangles(); ++t) {
      int& shell = number[Index(Root(t))];
      if (shell == kNone) {
        shell = static_cast<int>(mesh_.closed.size());
        mesh_.closed.push_back(true);
      }
      mesh_.shell.push_back(shell);
    }
    ForEachEdge([&](auto begin, auto end) {
      const auto upward = std::count_if(begin, end, [](const Side& side) { return side.upward; });
      if (2 * upward != end - begin)
        mesh_.closed[Index(mesh_.shell[Index(begin->triangle)])] = false;
    });
  }

  void TurnInsideOutShells() {
    struct Extent {
      double volume{0.0};  // [m^3], negative: inside out
      Eigen::AlignedBox3d box;
    };
    std::vector<Extent> extents(mesh_.closed.size());
    const Vector3d origin = mesh_.vertices.rowwise().mean();
    for (int t = 0; t < num_triangles(); ++t) {
      Extent& extent = extents[Index(mesh_.shell[Index(t)])];
      extent.volume += Area(t).dot(Corner(t, 0) - origin) / 3.0;
      for (int k = 0; k < 3; ++k) extent.box.extend(Corner(t, k));
    }
    std::vector<bool> inside_out(extents.size(), false);
    for (std::size_t s = 0; s < extents.size(); ++s) {
      if (!mesh_.closed[s] || extents[s].volume >= 0.0) continue;
      inside_out[s] = true;
      for (std::size_t other = 0; other < extents.size(); ++other) {
        const bool larger = mesh_.closed[other] && extents[other].volume > -extents[s].volume;
        if (larger && extents[other].box.contains(extents[s].box)) inside_out[s] = false;
      }
    }
    for (int t = 0; t < num_triangles(); ++t) {
      if (inside_out[Index(mesh_.shell[Index(t)])]) Turn(t);
    }
  }

  RepairedTriangles mesh_;
  std::vector<Side> sides_;  // sorted by their ends
  std::vector<bool> turn_;
  std::vector<int> parent_;  // of triangles in a shell: disjoint sets
};

}  // namespace

RepairedTriangles RepairTriangles(const Matrix3Xd& vertices, const Matrix3Xi& triangles) {
  return Repair(vertices, triangles).Run();
}

}  // namespace vacuum_gripper_sim
