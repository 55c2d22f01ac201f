#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

namespace vacuum_gripper_sim {

/// Raw triangles, as a file holds them.
struct Triangles {
  Eigen::Matrix3Xd vertices;   // 3 by #V [m]
  Eigen::Matrix3Xi triangles;  // 3 by #F
};

inline Triangles Join(const Triangles& a, const Triangles& b) {
  Triangles all;
  all.vertices.resize(3, a.vertices.cols() + b.vertices.cols());
  all.vertices << a.vertices, b.vertices;
  all.triangles.resize(3, a.triangles.cols() + b.triangles.cols());
  all.triangles << a.triangles,
      (b.triangles.array() + static_cast<int>(a.vertices.cols())).matrix();
  return all;
}

/// Every triangle with corners of its own, as in an STL file.
inline Triangles Soup(const Triangles& mesh) {
  Triangles soup;
  soup.vertices.resize(3, 3 * mesh.triangles.cols());
  soup.triangles.resize(3, mesh.triangles.cols());
  for (Eigen::Index i = 0; i < soup.vertices.cols(); ++i) {
    soup.vertices.col(i) = mesh.vertices.col(mesh.triangles(i % 3, i / 3));
    soup.triangles(i % 3, i / 3) = static_cast<int>(i);
  }
  return soup;
}

/// n by n squares of two triangles each around the origin in z = 0, front up.
inline Triangles MakeSheet(int n, double width) {
  Triangles sheet;
  sheet.vertices.resize(3, (n + 1) * (n + 1));
  sheet.triangles.resize(3, 2 * n * n);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      sheet.vertices.col(j * (n + 1) + i) << width * i / n - 0.5 * width,
          width * j / n - 0.5 * width, 0.0;
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int corner = j * (n + 1) + i;
      sheet.triangles.col(2 * (j * n + i)) << corner, corner + 1, corner + n + 2;
      sheet.triangles.col(2 * (j * n + i) + 1) << corner, corner + n + 2, corner + n + 1;
    }
  }
  return sheet;
}

/// Around the origin, 12 n^2 triangles, front outside.
inline Triangles MakeBoxMesh(int n, const Eigen::Vector3d& size) {
  Triangles box;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Triangles face = MakeSheet(n, 1.0);
      Eigen::Matrix3d R = Eigen::Matrix3d::Zero();  // its x, y, z along box axes
      R((axis + 1) % 3, 0) = 1.0;
      R((axis + 2) % 3, 1) = sign;
      R(axis, 2) = sign;
      face.vertices.row(2).setConstant(0.5);
      face.vertices = size.asDiagonal() * (R * face.vertices);
      box = box.vertices.cols() == 0 ? face : Join(box, face);
    }
  }
  return box;
}

/// A sphere around the origin by bending a box of 12 n^2 triangles, its vertices on the sphere.
inline Triangles MakeSphereMesh(int n, double radius) {
  Triangles sphere = MakeBoxMesh(n, {1.0, 1.0, 1.0});
  // Equal angles rather than equal lengths: triangles of about one size.
  sphere.vertices = (sphere.vertices.array() * (0.5 * M_PI)).tan().matrix();
  sphere.vertices.colwise().normalize();
  sphere.vertices *= radius;
  return sphere;
}

}  // namespace vacuum_gripper_sim
