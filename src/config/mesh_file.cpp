#include "vacuum_gripper_sim/config/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "vacuum_gripper_sim/config/package_paths.h"

namespace vacuum_gripper_sim {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxWidth = 10.0;  // [m]

/// The path that a URI means. @throws std::invalid_argument with the reason alone.
fs::path Resolve(const std::string& uri, const std::string& base) {
  const std::size_t colon = uri.find("://");
  if (colon == std::string::npos) {
    const fs::path path(uri);
    if (path.is_relative() && base.empty()) {
      throw std::invalid_argument("a relative path, but the scene comes from no file; expected " +
                                  std::string("package://, file:// or an absolute path"));
    }
    return path.is_relative() ? fs::path(base) / path : path;
  }
  const std::string scheme = uri.substr(0, colon);
  const std::string rest = uri.substr(colon + 3);
  if (scheme == "file") {
    if (rest.empty() || rest.front() != '/') {
      throw std::invalid_argument("expected three slashes, file:///path");
    }
    return rest;
  }
  if (scheme != "package") {
    throw std::invalid_argument("unknown scheme " + scheme +
                                "://; expected package://, file:// or a path");
  }
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const std::string package = rest.substr(0, slash);
  const std::string directory = package.empty() ? "" : PackageDirectory(package);
  if (directory.empty()) {
    throw std::invalid_argument("no package '" + package +
                                "'; expected one in ROS_PACKAGE_PATH or " + "CMAKE_PREFIX_PATH");
  }
  return fs::path(directory) / rest.substr(std::min(slash + 1, rest.size()));
}

void CheckFile(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    throw std::invalid_argument("no such file " + path.lexically_normal().string());
  }
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".stl" && extension != ".obj" && extension != ".dae") {
    throw std::invalid_argument("a file of type '" + extension + "'; expected .stl, .obj or .dae");
  }
}

std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::isspace(c) != 0; }, ' ');
  return text;
}

/// Gathers the triangles of a node and those below it.
class Collector {
 public:
  explicit Collector(const aiScene& scene) : scene_(scene) {
    Collect(*scene.mRootNode, Eigen::Matrix4d::Identity());
  }

  /// @returns 3 by #V. [m]
  Eigen::Matrix3Xd Vertices() const {
    return Eigen::Map<const Eigen::Matrix3Xd>(vertices_.data(), 3,
                                              static_cast<Eigen::Index>(vertices_.size() / 3));
  }
  Eigen::Matrix3Xi Triangles() const {
    return Eigen::Map<const Eigen::Matrix3Xi>(triangles_.data(), 3,
                                              static_cast<Eigen::Index>(triangles_.size() / 3));
  }

 private:
  void Collect(const aiNode& node, const Eigen::Matrix4d& X_parent) {
    Eigen::Matrix4d X;
    for (unsigned i = 0; i < 4; ++i) {
      for (unsigned j = 0; j < 4; ++j) {
        X(i, j) = static_cast<double>(node.mTransformation[i][j]);
      }
    }
    X = X_parent * X;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) Append(*scene_.mMeshes[node.mMeshes[m]], X);
    for (unsigned c = 0; c < node.mNumChildren; ++c) Collect(*node.mChildren[c], X);
  }

  void Append(const aiMesh& mesh, const Eigen::Matrix4d& X) {
    const auto first = static_cast<int>(vertices_.size() / 3);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      const Eigen::Vector4d point(static_cast<double>(p.x), static_cast<double>(p.y),
                                  static_cast<double>(p.z), 1.0);
      const Eigen::Vector4d placed = X * point;
      vertices_.insert(vertices_.end(), placed.data(), placed.data() + 3);
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      for (unsigned k = 0; k < 3; ++k) {
        triangles_.push_back(first + static_cast<int>(face.mIndices[k]));
      }
    }
  }

  const aiScene& scene_;
  std::vector<double> vertices_;  // x, y, z of each
  std::vector<int> triangles_;    // three of each
};

void CheckScale(const Eigen::Vector3d& scale) {
  if (scale.allFinite() && scale.cwiseAbs().minCoeff() > 0.0) return;
  std::ostringstream message;
  message << "scale = " << scale.x() << ' ' << scale.y() << ' ' << scale.z()
          << "; expected three finite numbers other than 0";
  throw std::invalid_argument(message.str());
}

void CheckWidth(const Eigen::Matrix3Xd& vertices) {
  const double width = (vertices.rowwise().maxCoeff() - vertices.rowwise().minCoeff()).maxCoeff();
  if (width <= kMaxWidth) return;
  std::ostringstream message;
  message << "the mesh is " << width << " m wide, must be at most " << kMaxWidth
          << " m: it looks like millimetres, for which the scale is 0.001 0.001 0.001";
  throw std::invalid_argument(message.str());
}

Mesh Read(const fs::path& path, const Eigen::Vector3d& scale) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw std::invalid_argument("cannot be read: " + OneLine(importer.GetErrorString()));
  }
  const Collector collector(*scene);
  const Eigen::Matrix3Xd vertices = scale.asDiagonal() * collector.Vertices();
  Eigen::Matrix3Xi triangles = collector.Triangles();
  if (scale.prod() < 0.0) triangles.row(1).swap(triangles.row(2));  // a mirror turns them
  // The mesh names itself by its file; the caller has said which.
  const std::string name = path.filename().string();
  auto mesh = std::make_shared<const TriangleMesh>(name, vertices, triangles);
  CheckWidth(mesh->vertices());
  return mesh;
}

}  // namespace

Mesh MeshFiles::Load(const std::string& field, const std::string& uri,
                     const Eigen::Vector3d& scale) {
  try {
    const fs::path path = Resolve(uri, base_);
    CheckScale(scale);
    CheckFile(path);
    const auto key =
        std::make_tuple(path.lexically_normal().string(), scale.x(), scale.y(), scale.z());
    Mesh& mesh = loaded_[key];
    if (mesh == nullptr) mesh = Read(path, scale);
    return mesh;
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(field + " = " + uri + ": " + e.what());
  }
}

}  // namespace vacuum_gripper_sim
