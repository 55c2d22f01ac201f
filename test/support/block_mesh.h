#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/** A box of nx by ny by nz cells, six tetrahedra a cell, for tests of the elements; it has no
 cavity. Mount: the nodes at x = 0. @param quadratic Adds the mid-edge nodes. */
inline TetMesh MakeBlock(int nx, int ny, int nz, const Eigen::Vector3d& size, bool quadratic) {
  std::vector<Eigen::Vector3d> nodes;
  const auto corner = [&](int i, int j, int k) { return (i * (ny + 1) + j) * (nz + 1) + k; };
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) {
      for (int k = 0; k <= nz; ++k) {
        nodes.emplace_back(size.x() * i / nx, size.y() * j / ny, size.z() * k / nz);
      }
    }
  }
  std::vector<std::vector<int>> elements;
  // The six paths along edges from (0,0,0) to (1,1,1), one a permutation of the axes.
  constexpr int kPaths[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (int k = 0; k < nz; ++k) {
        for (const auto& path : kPaths) {
          std::array<int, 3> at{i, j, k};
          std::vector<int> element{corner(at[0], at[1], at[2])};
          for (const int axis : path) {
            ++at[static_cast<std::size_t>(axis)];
            element.push_back(corner(at[0], at[1], at[2]));
          }
          const auto p = [&](int a) { return nodes[static_cast<std::size_t>(element[a])]; };
          if ((p(1) - p(0)).cross(p(2) - p(0)).dot(p(3) - p(0)) < 0.0) {
            std::swap(element[2], element[3]);
          }
          elements.push_back(element);
        }
      }
    }
  }
  if (quadratic) {
    constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    std::map<std::pair<int, int>, int> middles;
    for (auto& element : elements) {
      for (const auto& edge : kEdges) {
        const auto ends = std::minmax(element[edge[0]], element[edge[1]]);
        const auto [place, is_new] = middles.try_emplace(ends, static_cast<int>(nodes.size()));
        if (is_new) {
          nodes.emplace_back(0.5 * (nodes[static_cast<std::size_t>(ends.first)] +
                                    nodes[static_cast<std::size_t>(ends.second)]));
        }
        element.push_back(place->second);
      }
    }
  }
  TetMesh mesh;
  mesh.source = "block";
  mesh.nodes.resize(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    mesh.nodes.col(static_cast<Eigen::Index>(n)) = nodes[n];
    if (nodes[n].x() == 0.0) mesh.mount_nodes.push_back(static_cast<int>(n));
  }
  mesh.elements.resize(quadratic ? 10 : 4, static_cast<Eigen::Index>(elements.size()));
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (std::size_t a = 0; a < elements[e].size(); ++a) {
      mesh.elements(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(e)) = elements[e][a];
    }
  }
  return mesh;
}

/// One face of the block with all corners at zero of an axis, 3 or 6 by 1.
inline Eigen::MatrixXi FaceAtZero(const TetMesh& block, int axis) {
  constexpr int kFaces[4][6] = {
      {0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}};
  for (Eigen::Index e = 0; e < block.elements.cols(); ++e) {
    for (const auto& corners : kFaces) {
      Eigen::MatrixXi face(block.quadratic() ? 6 : 3, 1);
      double sum = 0.0;
      for (int k = 0; k < face.rows(); ++k) {
        face(k) = block.elements(corners[k], e);
        sum += block.nodes(axis, face(k));
      }
      if (sum == 0.0) return face;
    }
  }
  throw std::logic_error("a block without a face at zero");
}

/// The block with its boundary; one face at x = 0 stands in for the mount and one at y = 0 for the
/// cavity.
inline TetMesh WithBoundary(const TetMesh& block) {
  return MakeTetMesh(block.source, block.nodes, block.elements, FaceAtZero(block, 1),
                     FaceAtZero(block, 0));
}

}  // namespace vacuum_gripper_sim
