#include "vacuum_gripper_sim/config/vtu_writer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <locale>
#include <stdexcept>
#include <string>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

constexpr int kDigits = 12;
constexpr int kVtkTetra = 10;
constexpr int kVtkQuadraticTetra = 24;

void CheckSizes(const CupArray& cups, const StepResult& result) {
  const TetMesh& mesh = cups.mesh;
  const auto matches = [&](std::size_t size) {
    return size == 0 || size == cups.cavities.nodes.size();
  };
  if (result.x_W.cols() != mesh.nodes.cols() || !matches(result.gap.size()) ||
      !matches(result.classification.zones.size())) {
    throw std::invalid_argument("WriteVtu: the result has " + std::to_string(result.x_W.cols()) +
                                " nodes; expected those of the mesh, " +
                                std::to_string(mesh.nodes.cols()) +
                                ", and a gap and a zone for each cavity point");
  }
}

void OpenArray(const char* type, const char* name, int components, std::ostream* stream) {
  *stream << "        <DataArray type=\"" << type << "\" Name=\"" << name
          << "\" NumberOfComponents=\"" << components << "\" format=\"ascii\">\n";
}

void CloseArray(std::ostream* stream) { *stream << "        </DataArray>\n"; }

void WriteVectors(const char* name, const Eigen::Matrix3Xd& vectors, std::ostream* stream) {
  OpenArray("Float64", name, 3, stream);
  for (Eigen::Index i = 0; i < vectors.cols(); ++i) {
    *stream << vectors(0, i) << ' ' << vectors(1, i) << ' ' << vectors(2, i) << '\n';
  }
  CloseArray(stream);
}

template <typename T>
void WriteScalars(const char* type, const char* name, const std::vector<T>& values,
                  std::ostream* stream) {
  OpenArray(type, name, 1, stream);
  for (const T& value : values) *stream << value << '\n';
  CloseArray(stream);
}

void WriteCells(const TetMesh& mesh, std::ostream* stream) {
  const Eigen::Index nodes_per_cell = mesh.elements.rows();
  *stream << "      <Cells>\n";
  OpenArray("Int32", "connectivity", 1, stream);
  for (Eigen::Index e = 0; e < mesh.elements.cols(); ++e) {
    for (Eigen::Index i = 0; i < nodes_per_cell; ++i) {
      *stream << mesh.elements(i, e) << (i + 1 < nodes_per_cell ? ' ' : '\n');
    }
  }
  CloseArray(stream);
  OpenArray("Int32", "offsets", 1, stream);
  for (Eigen::Index e = 1; e <= mesh.elements.cols(); ++e) *stream << e * nodes_per_cell << '\n';
  CloseArray(stream);
  OpenArray("UInt8", "types", 1, stream);
  for (Eigen::Index e = 0; e < mesh.elements.cols(); ++e) {
    *stream << (mesh.quadratic() ? kVtkQuadraticTetra : kVtkTetra) << '\n';
  }
  CloseArray(stream);
  *stream << "      </Cells>\n";
}

void WritePointData(const CupArray& cups, const StepResult& result, std::ostream* stream) {
  const CavitySurface& cavity = cups.cavities;
  const Eigen::Matrix3Xd rest_W = result.X_WM * cups.rest_M;
  const auto num_nodes = static_cast<std::size_t>(cups.mesh.num_nodes());
  std::vector<int> zone(num_nodes, -1);
  std::vector<double> gap(num_nodes, kNoGap);
  for (std::size_t i = 0; i < cavity.nodes.size(); ++i) {
    const auto node = static_cast<std::size_t>(cavity.nodes[i]);
    if (!result.classification.zones.empty()) {
      zone[node] = static_cast<int>(result.classification.zones[i]);
    }
    if (!result.gap.empty() && std::isfinite(result.gap[i])) {
      gap[node] = std::min(result.gap[i], kNoGap);
    }
  }
  *stream << "      <PointData Scalars=\"zone\" Vectors=\"displacement\">\n";
  WriteVectors("displacement", result.x_W - rest_W, stream);
  WriteScalars("Int32", "zone", zone, stream);
  WriteScalars("Float64", "gap", gap, stream);
  *stream << "      </PointData>\n";
}

}  // namespace

void WriteVtu(const CupArray& cups, const StepResult& result, std::ostream* stream) {
  CheckSizes(cups, result);
  const TetMesh& mesh = cups.mesh;
  stream->imbue(std::locale::classic());
  stream->precision(kDigits);
  *stream << "<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
             "  <UnstructuredGrid>\n"
          << "    <Piece NumberOfPoints=\"" << mesh.num_nodes() << "\" NumberOfCells=\""
          << mesh.num_elements() << "\">\n"
          << "      <Points>\n";
  WriteVectors("Points", result.x_W, stream);
  *stream << "      </Points>\n";
  WriteCells(mesh, stream);
  WritePointData(cups, result, stream);
  *stream << "    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace vacuum_gripper_sim
