#include "vacuum_gripper_sim/core/cup_faces.h"

#include <cmath>
#include <cstddef>

namespace vacuum_gripper_sim {
namespace {

/// Nearer than this the direction from the nearest point is rounding alone. [m]
constexpr double kTouching = 1e-10;

}  // namespace

CupFaces::CupFaces(const TetMesh& mesh)
    : triangles_(SplitFaces(mesh.boundary_faces)),
      topology_(triangles_, mesh.num_nodes()),
      x_W_(mesh.nodes) {
  FitBoxes();
  tree_ = BoxTree(boxes_);
}

void CupFaces::FitBoxes() {
  boxes_.assign(static_cast<std::size_t>(triangles_.cols()), Eigen::AlignedBox3d());
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
    Eigen::AlignedBox3d& box = boxes_[static_cast<std::size_t>(t)];
    for (int k = 0; k < 3; ++k) box.extend(x_W_.col(triangles_(k, t)));
  }
}

void CupFaces::Update(const Eigen::Matrix3Xd& x_W) {
  x_W_ = x_W;
  FitBoxes();
  tree_.Refit(boxes_);
}

/// Of equally near faces the first counts, whatever the tree's order.
void CupFaces::Consider(int face, const Eigen::Vector3d& p_W, Candidate* best) const {
  const TrianglePoint at =
      NearestOnTriangle(x_W_.col(triangles_(0, face)), x_W_.col(triangles_(1, face)),
                        x_W_.col(triangles_(2, face)), p_W);
  const double bound = best->at.squared_distance;
  if (at.squared_distance > bound) return;
  if (at.squared_distance == bound && best->face >= 0 && best->face < face) return;
  *best = {face, at};
}

CupFacePoint CupFaces::On(int face, const Eigen::Vector3d& p_W) const {
  Candidate only;
  only.at.squared_distance = std::numeric_limits<double>::infinity();
  Consider(face, p_W, &only);
  return Describe(only, p_W);
}

CupFacePoint CupFaces::Describe(const Candidate& nearest, const Eigen::Vector3d& p_W) const {
  CupFacePoint result;
  result.face = nearest.face;
  result.weights = nearest.at.weights;
  result.position_W.setZero();
  for (int k = 0; k < 3; ++k) {
    const int node = triangles_(k, nearest.face);
    result.nodes[static_cast<std::size_t>(k)] = node;
    result.position_W += result.weights(k) * x_W_.col(node);
  }
  const Eigen::Vector3d outward =
      Pseudonormal(triangles_, x_W_, topology_, nearest.face, result.weights,
                   [&](int face) { return TriangleNormal(triangles_, x_W_, face); });
  const Eigen::Vector3d way = p_W - result.position_W;
  const double length = std::sqrt(nearest.at.squared_distance);
  const double sign = way.dot(outward) < 0.0 ? -1.0 : 1.0;
  result.distance = sign * length;
  result.normal_W =
      length > kTouching ? Eigen::Vector3d(sign / length * way) : outward.normalized();
  return result;
}

}  // namespace vacuum_gripper_sim
