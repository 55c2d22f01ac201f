#pragma once

#include <Eigen/Dense>

#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// Volume of a mesh: exact for straight elements and, with the 5-point rule of degree 3, for the
/// cubic Jacobian of quadratic ones. [m^3]
inline double Volume(const TetMesh& mesh) {
  static constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  double volume = 0.0;
  for (int e = 0; e < mesh.num_elements(); ++e) {
    for (int sample = 0; sample < 5; ++sample) {
      Eigen::Vector4d l = Eigen::Vector4d::Constant(sample == 4 ? 0.25 : 1.0 / 6.0);
      if (sample < 4) l(sample) = 0.5;
      Eigen::Matrix<double, 3, 4> dx = Eigen::Matrix<double, 3, 4>::Zero();
      for (int k = 0; k < 4; ++k) {
        const double slope = mesh.quadratic() ? 4.0 * l(k) - 1.0 : 1.0;
        dx.col(k) += slope * mesh.nodes.col(mesh.elements(k, e));
      }
      for (int k = 0; mesh.quadratic() && k < 6; ++k) {
        const Eigen::Vector3d x = mesh.nodes.col(mesh.elements(4 + k, e));
        dx.col(kEdges[k][0]) += 4.0 * l(kEdges[k][1]) * x;
        dx.col(kEdges[k][1]) += 4.0 * l(kEdges[k][0]) * x;
      }
      const Eigen::Matrix3d J = dx.rightCols<3>().colwise() - dx.col(0);
      volume += J.determinant() / 6.0 * (sample == 4 ? -0.8 : 0.45);
    }
  }
  return volume;
}

}  // namespace vacuum_gripper_sim
