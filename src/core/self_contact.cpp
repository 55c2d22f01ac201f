#include "vacuum_gripper_sim/core/self_contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace vacuum_gripper_sim {
namespace {

/// Cosine below which two outward normals face each other: they enclose more than 105 degrees.
constexpr double kFacing = -0.25;

/// Nearer than this, the face's own normal counts: that of an edge or a corner between faces, and
/// the direction to a point as near, would tilt a contact at rest. [m]
constexpr double kTouching = 1e-8;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

FoldContact MakeContact(int node, const CupFacePoint& point, const Eigen::Vector3d& face_normal) {
  const bool touching = std::abs(point.distance) < kTouching;
  return {node,          point.face,     point.nodes,
          point.weights, point.distance, touching ? face_normal : point.normal_W};
}

/// For each of `centres` the triangles that have a corner at most `edges` edges away, ascending.
std::vector<std::vector<int>> TrianglesAround(const Eigen::Matrix3Xi& triangles, int num_nodes,
                                              const std::vector<int>& centres, int edges) {
  const TriangleTopology topology(triangles, num_nodes);
  constexpr int kNowhere = -1;
  std::vector<int> reached_from(static_cast<std::size_t>(triangles.cols()), kNowhere);
  std::vector<std::vector<int>> around;
  for (const int centre : centres) {
    std::vector<int> found, rim{centre};
    for (int edge = 0; edge <= edges; ++edge) {
      std::vector<int> next_rim;
      for (const int node : rim) {
        const int end = topology.corners_begin[Index(node) + 1];
        for (int i = topology.corners_begin[Index(node)]; i < end; ++i) {
          const int t = topology.corners[Index(i)] / 3;
          if (reached_from[Index(t)] == centre) continue;
          reached_from[Index(t)] = centre;
          found.push_back(t);
          for (int k = 0; k < 3; ++k) next_rim.push_back(triangles(k, t));
        }
      }
      rim = std::move(next_rim);
    }
    std::sort(found.begin(), found.end());
    around.push_back(std::move(found));
  }
  return around;
}

}  // namespace

SelfContact::SelfContact(const TetMesh& mesh, const CupFaces& faces) {
  const Eigen::Matrix3Xi& triangles = faces.triangles();
  nodes_.assign(triangles.data(), triangles.data() + triangles.size());
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  const auto clamped = [&](int node) {
    return std::binary_search(mesh.mount_nodes.begin(), mesh.mount_nodes.end(), node);
  };
  nodes_.erase(std::remove_if(nodes_.begin(), nodes_.end(), clamped), nodes_.end());
  // An edge of a quadratic element is two of its triangles' edges.
  neighbours_ = TrianglesAround(triangles, mesh.num_nodes(), nodes_,
                                mesh.quadratic() ? 2 * kNeighborhood : kNeighborhood);

  FindNormals(triangles, mesh.nodes);
  half_walls_.assign(Index(mesh.num_nodes()), 0.0);
  for (const int node : nodes_) {
    // The thickness: to the nearest face behind the node that looks the other way.
    const Eigen::Vector3d p = mesh.nodes.col(node);
    const Eigen::Vector3d outward = normals_.of_nodes.col(node);
    const auto behind = [&](int t) {
      return normals_.of_triangles.col(t).dot(outward) < kFacing &&
             outward.dot(mesh.nodes.col(triangles(0, t)) - p) < 0.0;
    };
    const std::optional<CupFacePoint> other =
        faces.Nearest(p, std::numeric_limits<double>::infinity(), behind);
    if (other) half_walls_[Index(node)] = 0.5 * std::abs(other->distance);
  }
}

void SelfContact::FindNormals(const Eigen::Matrix3Xi& triangles, const Eigen::Matrix3Xd& x) const {
  normals_.of_triangles.resize(3, triangles.cols());
  normals_.of_nodes.setZero(3, x.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3d a = x.col(triangles(0, t));
    const Eigen::Vector3d b = x.col(triangles(1, t));
    const Eigen::Vector3d c = x.col(triangles(2, t));
    const Eigen::Vector3d area = (b - a).cross(c - a);
    normals_.of_triangles.col(t) = area.normalized();
    for (int k = 0; k < 3; ++k) normals_.of_nodes.col(triangles(k, t)) += area;
  }
  for (Eigen::Index i = 0; i < x.cols(); ++i) normals_.of_nodes.col(i).normalize();
}

bool SelfContact::MayTouch(std::size_t index, int triangle) const {
  return !std::binary_search(neighbours_[index].begin(), neighbours_[index].end(), triangle);
}

void SelfContact::Find(const CupFaces& faces, const Eigen::Matrix3Xd& x_W, double reach,
                       const std::vector<int>& nodes, std::vector<FoldContact>* contacts) const {
  contacts->clear();
  if (nodes.empty()) return;
  const Eigen::Matrix3Xi& triangles = faces.triangles();
  FindNormals(triangles, x_W);
  for (const int node : nodes) {
    const auto i = static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) -
                                            nodes_.begin());
    const Eigen::Vector3d p = x_W.col(node);
    const Eigen::Vector3d outward = normals_.of_nodes.col(node);
    const double depth = std::min(reach, half_walls_[Index(node)]);
    const auto wanted = [&](int t) {
      const auto normal = normals_.of_triangles.col(t);
      return normal.dot(outward) < kFacing && normal.dot(p - x_W.col(triangles(0, t))) > -depth &&
             MayTouch(i, t);
    };
    const std::optional<CupFacePoint> nearest = faces.Nearest(p, reach, wanted);
    if (!nearest || nearest->distance < -depth) continue;
    contacts->push_back(MakeContact(node, *nearest, normals_.of_triangles.col(nearest->face)));
  }
}

FoldContact SelfContact::At(const FoldContact& contact, const CupFaces& faces,
                            const Eigen::Matrix3Xd& x_W) {
  const CupFacePoint point = faces.On(contact.triangle, x_W.col(contact.node));
  return MakeContact(contact.node, point, TriangleNormal(faces.triangles(), x_W, contact.triangle));
}

}  // namespace vacuum_gripper_sim
