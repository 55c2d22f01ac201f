#include "vacuum_gripper_sim/core/tet_mesh.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXi;
using Eigen::Vector3d;

// Faces of a tetrahedron, counter-clockwise seen from outside: corners, then the mid-edge nodes of
// their edges 01, 12, 20. The first three rows serve the 4-node element.
constexpr int kFaceNodes[4][6] = {
    {0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}};
constexpr int kEdgeCorners[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
// Node order of the mirrored element: the corners 0 and 1 swapped.
constexpr int kMirrored[10] = {1, 0, 2, 3, 4, 6, 5, 8, 7, 9};

constexpr double kMaxWidth = 1.0;  // [m]
// A Jacobian below this fraction of the longest edge cubed is zero up to rounding.
constexpr double kFlat = 1e-9;

using CornerKey = std::array<int, 3>;

CornerKey SortedCorners(const int a, const int b, const int c) {
  CornerKey key{a, b, c};
  std::sort(key.begin(), key.end());
  return key;
}

// An element's side: which element, which of its four faces.
struct Side {
  int element;
  int face;
};

class Builder {
 public:
  explicit Builder(TetMesh mesh) : mesh_(std::move(mesh)) {}

  TetMesh Build(const MatrixXi& cavity_faces, const MatrixXi& mount_faces) {
    CheckShapes(cavity_faces, "cavity");
    CheckShapes(mount_faces, "mount");
    CheckNodes();
    CheckConnectivity();
    TurnMirroredElements();
    CheckJacobians();
    FindBoundary();
    mesh_.cavity_faces = OnBoundary(cavity_faces, "cavity");
    const MatrixXi mount = OnBoundary(mount_faces, "mount");
    mesh_.mount_nodes.assign(mount.data(), mount.data() + mount.size());
    std::sort(mesh_.mount_nodes.begin(), mesh_.mount_nodes.end());
    mesh_.mount_nodes.erase(std::unique(mesh_.mount_nodes.begin(), mesh_.mount_nodes.end()),
                            mesh_.mount_nodes.end());
    return std::move(mesh_);
  }

 private:
  template <typename... Parts>
  [[noreturn]] void Fail(const Parts&... parts) const {
    std::ostringstream message;
    message << mesh_.source << ": ";
    (message << ... << parts);
    throw std::invalid_argument(message.str());
  }

  // Nodes and elements are numbered from 0 in messages, as the caller's arrays are.
  std::string Node(const int node) const {
    std::ostringstream text;
    text << "node " << node << " (from 0) at (" << mesh_.nodes(0, node) << ", "
         << mesh_.nodes(1, node) << ", " << mesh_.nodes(2, node) << ") m";
    return text.str();
  }

  std::string Element(const int element) const {
    Vector3d centre = Vector3d::Zero();
    for (int k = 0; k < 4; ++k) centre += 0.25 * Corner(element, k);
    std::ostringstream text;
    text << "element " << element << " (from 0) about (" << centre.x() << ", " << centre.y() << ", "
         << centre.z() << ") m";
    return text.str();
  }

  Vector3d Corner(const int element, const int k) const {
    return mesh_.nodes.col(mesh_.elements(k, element));
  }

  void CheckShapes(const MatrixXi& faces, const char* group) const {
    if (mesh_.nodes.cols() == 0 || mesh_.elements.cols() == 0) {
      Fail("the mesh is empty (", mesh_.nodes.cols(), " nodes, ", mesh_.elements.cols(),
           " elements), must have at least one tetrahedron");
    }
    if (mesh_.elements.rows() != 4 && mesh_.elements.rows() != 10) {
      Fail("elements have ", mesh_.elements.rows(), " nodes, must have 4 or 10");
    }
    if (faces.cols() == 0) Fail("group `", group, "` is empty, must have at least one face");
    const int face_nodes = mesh_.quadratic() ? 6 : 3;
    if (faces.rows() != face_nodes) {
      Fail("faces of group `", group, "` have ", faces.rows(), " nodes, must have ", face_nodes,
           " with ", mesh_.elements.rows(), "-node elements");
    }
  }

  void CheckNodes() const {
    for (int i = 0; i < mesh_.num_nodes(); ++i) {
      if (!mesh_.nodes.col(i).allFinite()) Fail(Node(i), " is not finite");
    }
    const Vector3d width = mesh_.nodes.rowwise().maxCoeff() - mesh_.nodes.rowwise().minCoeff();
    if (width.maxCoeff() > kMaxWidth) {
      Fail("the mesh is ", width.maxCoeff(), " m wide, must be at most ", kMaxWidth,
           " m: is it in millimetres?");
    }
  }

  void CheckConnectivity() const {
    std::vector<bool> used(static_cast<std::size_t>(mesh_.num_nodes()), false);
    for (int e = 0; e < mesh_.num_elements(); ++e) {
      for (int k = 0; k < mesh_.elements.rows(); ++k) {
        const int node = mesh_.elements(k, e);
        if (node < 0 || node >= mesh_.num_nodes()) {
          Fail("element ", e, " (from 0) names node ", node, ", must be in 0 .. ",
               mesh_.num_nodes() - 1);
        }
        used[static_cast<std::size_t>(node)] = true;
      }
    }
    const auto unused = std::find(used.begin(), used.end(), false);
    if (unused != used.end()) {
      Fail(Node(static_cast<int>(unused - used.begin())), " belongs to no element");
    }
  }

  // Six times the volume of the tetrahedron of the corners. [m^3]
  double CornerJacobian(const int e) const {
    const Vector3d x0 = Corner(e, 0);
    return (Corner(e, 1) - x0).cross(Corner(e, 2) - x0).dot(Corner(e, 3) - x0);
  }

  void TurnMirroredElements() {
    for (int e = 0; e < mesh_.num_elements(); ++e) {
      if (CornerJacobian(e) >= 0.0) return;
    }
    const MatrixXi original = mesh_.elements;
    for (int k = 0; k < original.rows(); ++k) mesh_.elements.row(k) = original.row(kMirrored[k]);
  }

  // det(dx/dxi) of element e at barycentric coordinates `at`. [m^3]
  double Jacobian(const int e, const Eigen::Vector4d& at) const {
    if (!mesh_.quadratic()) return CornerJacobian(e);
    Eigen::Matrix<double, 3, 4> dx = Eigen::Matrix<double, 3, 4>::Zero();  // by the coordinates
    for (int k = 0; k < 4; ++k) dx.col(k) += (4.0 * at(k) - 1.0) * Corner(e, k);
    for (int k = 0; k < 6; ++k) {
      const int a = kEdgeCorners[k][0], b = kEdgeCorners[k][1];
      dx.col(a) += 4.0 * at(b) * Corner(e, 4 + k);
      dx.col(b) += 4.0 * at(a) * Corner(e, 4 + k);
    }
    Eigen::Matrix3d J;
    for (int k = 0; k < 3; ++k) J.col(k) = dx.col(k + 1) - dx.col(0);
    return J.determinant();
  }

  void CheckJacobians() const {
    constexpr double kNear = 0.58541019662496845446, kFar = 0.13819660112501051518;
    const int num_samples = mesh_.quadratic() ? 8 : 1;
    for (int e = 0; e < mesh_.num_elements(); ++e) {
      double longest = 0.0;
      for (const auto& edge : kEdgeCorners) {
        longest = std::max(longest, (Corner(e, edge[0]) - Corner(e, edge[1])).norm());
      }
      const double smallest_allowed = kFlat * longest * longest * longest;
      for (int sample = 0; sample < num_samples; ++sample) {
        const bool corner = sample < 4;
        Eigen::Vector4d at = Eigen::Vector4d::Constant(corner ? 0.0 : kFar);
        at(sample % 4) = corner ? 1.0 : kNear;
        const double jacobian = Jacobian(e, at);
        if (jacobian > smallest_allowed) continue;
        std::ostringstream where;
        if (mesh_.quadratic()) {
          where << " at " << (corner ? "corner " : "integration point ") << sample % 4;
        }
        Fail(Element(e), jacobian < -smallest_allowed ? " is inverted" : " is degenerate",
             ": its Jacobian", where.str(), " is ", jacobian, " m^3, must be > ", smallest_allowed);
      }
    }
  }

  int FaceNode(const Side& side, const int k) const {
    return mesh_.elements(kFaceNodes[side.face][k], side.element);
  }

  CornerKey Key(const Side& side) const {
    return SortedCorners(FaceNode(side, 0), FaceNode(side, 1), FaceNode(side, 2));
  }

  // The faces that one element alone has; sorted by element, so that the order is that of the file.
  void FindBoundary() {
    std::vector<std::pair<CornerKey, Side>> sides;
    sides.reserve(4 * static_cast<std::size_t>(mesh_.num_elements()));
    for (int e = 0; e < mesh_.num_elements(); ++e) {
      for (int f = 0; f < 4; ++f) sides.emplace_back(Key({e, f}), Side{e, f});
    }
    std::stable_sort(sides.begin(), sides.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Side> boundary;
    for (std::size_t i = 0; i < sides.size();) {
      std::size_t end = i + 1;
      while (end < sides.size() && sides[end].first == sides[i].first) ++end;
      if (end - i == 1) boundary.push_back(sides[i].second);
      if (end - i == 2) CheckConforming(sides[i].second, sides[i + 1].second);
      if (end - i > 2) {
        Fail("the face of the nodes ", sides[i].first[0], ", ", sides[i].first[1], ", ",
             sides[i].first[2], " (from 0) belongs to ", end - i,
             " elements, must belong to at most 2; the last is ",
             Element(sides[end - 1].second.element));
      }
      i = end;
    }
    std::sort(boundary.begin(), boundary.end(), [](const Side& a, const Side& b) {
      return std::make_pair(a.element, a.face) < std::make_pair(b.element, b.face);
    });
    const int face_nodes = mesh_.quadratic() ? 6 : 3;
    mesh_.boundary_faces.resize(face_nodes, static_cast<int>(boundary.size()));
    for (std::size_t i = 0; i < boundary.size(); ++i) {
      const int column = static_cast<int>(i);
      for (int k = 0; k < face_nodes; ++k) {
        mesh_.boundary_faces(k, column) = FaceNode(boundary[i], k);
      }
      column_of_[Key(boundary[i])] = column;
    }
  }

  // Two elements that share the corners of a face share its mid-edge nodes.
  void CheckConforming(const Side& a, const Side& b) const {
    if (!mesh_.quadratic()) return;
    if (SortedCorners(FaceNode(a, 3), FaceNode(a, 4), FaceNode(a, 5)) !=
        SortedCorners(FaceNode(b, 3), FaceNode(b, 4), FaceNode(b, 5))) {
      Fail(Element(a.element), " and element ", b.element,
           " have a face in common but not its mid-edge nodes");
    }
  }

  MatrixXi OnBoundary(const MatrixXi& faces, const char* group) const {
    MatrixXi result(faces.rows(), faces.cols());
    std::vector<bool> taken(static_cast<std::size_t>(mesh_.boundary_faces.cols()), false);
    for (int i = 0; i < faces.cols(); ++i) {
      const auto found = column_of_.find(SortedCorners(faces(0, i), faces(1, i), faces(2, i)));
      const auto name = [&] {
        std::ostringstream face;
        face << "face " << i << " (from 0) of group `" << group << "`, nodes " << faces(0, i)
             << ", " << faces(1, i) << ", " << faces(2, i) << ",";
        return face.str();
      };
      if (found == column_of_.end()) {
        Fail(name(), " is not on the boundary of the volume, must be a face of one element");
      }
      const auto outward = mesh_.boundary_faces.col(found->second);
      if (faces.rows() == 6 && SortedCorners(faces(3, i), faces(4, i), faces(5, i)) !=
                                   SortedCorners(outward(3), outward(4), outward(5))) {
        Fail(name(), " has other mid-edge nodes than its element");
      }
      if (taken[static_cast<std::size_t>(found->second)]) Fail(name(), " is there twice");
      taken[static_cast<std::size_t>(found->second)] = true;
      result.col(i) = outward;
    }
    return result;
  }

  TetMesh mesh_;
  std::map<CornerKey, int> column_of_;  // corners of a boundary face -> its column
};

}  // namespace

TetMesh MakeTetMesh(std::string source, Matrix3Xd nodes, MatrixXi elements,
                    const MatrixXi& cavity_faces, const MatrixXi& mount_faces) {
  TetMesh mesh;
  mesh.source = std::move(source);
  mesh.nodes = std::move(nodes);
  mesh.elements = std::move(elements);
  return Builder(std::move(mesh)).Build(cavity_faces, mount_faces);
}

Eigen::Matrix3Xi SplitFaces(const MatrixXi& faces) {
  if (faces.rows() == 3) return faces;
  constexpr int kParts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  Eigen::Matrix3Xi triangles(3, 4 * faces.cols());
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    for (int part = 0; part < 4; ++part) {
      for (int k = 0; k < 3; ++k) triangles(k, 4 * f + part) = faces(kParts[part][k], f);
    }
  }
  return triangles;
}

}  // namespace vacuum_gripper_sim
