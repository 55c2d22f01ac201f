// The bell with its lip bead clamped and pressure on the inner dome; nothing touches it.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "validation/reference_case.h"
#include "validation/statics.h"

namespace vacuum_gripper_sim {
namespace {

/// A bell, its bead's nodes and the surface of the dome inside.
struct Dome {
  TetMesh mesh;
  std::vector<int> bead;
  CavitySurface inner;
};

/// The reference's own mesh: `mount` is the bead there, `cavity` the inner dome.
Dome LinearDome() {
  Dome dome{LoadReferenceMesh("dome_linear"), {}, {}};
  dome.bead = dome.mesh.mount_nodes;
  dome.inner = MakeCavitySurface(dome.mesh);
  return dome;
}

/// Our bell, whose cavity is dome and bead: the dome's faces lie on the inner sphere.
Dome QuadraticDome() {
  Dome dome{
      ReadGmsh(std::string(VACUUM_GRIPPER_SOURCE_DIR) + "/meshes/bell_quadratic_700.msh"), {}, {}};
  const Eigen::Vector3d centre(0.0, 0.0, -0.013731238266578634);
  constexpr double kInnerRadius = 0.02275;
  const auto on_sphere = [&](int node) {
    return std::abs((dome.mesh.nodes.col(node) - centre).norm() - kInnerRadius) < 1e-7;
  };
  const Eigen::MatrixXi faces = dome.mesh.cavity_faces;
  TetMesh inner = dome.mesh;
  int num_inner = 0;
  std::set<int> bead;
  for (int f = 0; f < faces.cols(); ++f) {
    const int* const nodes = faces.col(f).data();
    if (std::all_of(nodes, nodes + faces.rows(), on_sphere)) {
      inner.cavity_faces.col(num_inner++) = faces.col(f);
    } else {
      bead.insert(nodes, nodes + faces.rows());
    }
  }
  inner.cavity_faces.conservativeResize(Eigen::NoChange, num_inner);
  dome.inner = MakeCavitySurface(inner);
  dome.bead.assign(bead.begin(), bead.end());
  return dome;
}

/// Height change of the cavity's apex [m]; checks the support on the way.
double ApexRise(const Dome& dome, double pressure, const std::string& name,
                MaterialModel model = MaterialModel::kCorotational) {
  Statics statics(dome.mesh, ReferenceA20(model), dome.bead);
  statics.SetPressure(dome.inner, pressure);
  const Statics::Solution solution = statics.Solve(4);
  // The loop between dome and bead is clamped: its area does not change.
  const double area = PointAreaVectors(dome.inner, dome.mesh.nodes).row(2).sum();
  Compare(name + " support [N]", solution.support.z(), -pressure * area, 1e-5);
  EXPECT_NEAR(solution.support.head<2>().norm(), 0.0, 1e-5 * std::abs(solution.support.z()));
  const int apex = dome.inner.nodes[static_cast<std::size_t>(dome.inner.port.front())];
  EXPECT_NEAR(dome.mesh.nodes(2, apex), 0.009018762, 1e-7);
  return solution.x(2, apex) - dome.mesh.nodes(2, apex);
}

TEST(Dome, LinearElementsAgainstTheSameMesh) {
  const Dome dome = LinearDome();
  Compare("dome linear, -2 kPa: apex uz [m]", ApexRise(dome, -2000.0, "dome linear, -2 kPa:"),
          {-4.615211e-4, -4.425066e-4}, 0.03);
  Compare("dome linear, +2 kPa: apex uz [m]", ApexRise(dome, 2000.0, "dome linear, +2 kPa:"),
          {4.098169e-4, 4.249573e-4}, 0.03);
  Compare("dome linear: projected area [m^2]",
          PointAreaVectors(dome.inner, dome.mesh.nodes).row(2).sum(), 1.9602318735077031 / 2000.0,
          1e-9);
}

TEST(Dome, QuadraticElementsAgainstTheConvergedSolution) {
  const Dome dome = QuadraticDome();
  Compare("dome quadratic: projected area [m^2]",
          PointAreaVectors(dome.inner, dome.mesh.nodes).row(2).sum(), 1.9848273288251552 / 2000.0,
          0.02);
  Compare("dome quadratic, -2 kPa: apex uz [m]", ApexRise(dome, -2000.0, "dome quadratic, -2 kPa:"),
          {-6.156391e-4, -5.788617e-4}, 0.03);
  Compare("dome quadratic, +2 kPa: apex uz [m]", ApexRise(dome, 2000.0, "dome quadratic, +2 kPa:"),
          {5.129908e-4, 5.374454e-4}, 0.03);
}

TEST(Dome, NeoHookeanAgainstNeoHookean) {
  const auto compare = [](const Dome& dome, double pressure, const std::string& name,
                          double reference) {
    Compare(name + " apex uz [m]", ApexRise(dome, pressure, name, MaterialModel::kNeoHookean),
            reference, 0.03);
  };
  compare(LinearDome(), -2000.0, "dome linear nh, -2 kPa:", -4.425066e-4);
  compare(LinearDome(), 2000.0, "dome linear nh, +2 kPa:", 4.249573e-4);
  compare(QuadraticDome(), -2000.0, "dome quadratic nh, -2 kPa:", -5.788617e-4);
  compare(QuadraticDome(), 2000.0, "dome quadratic nh, +2 kPa:", 5.374454e-4);
}

}  // namespace
}  // namespace vacuum_gripper_sim
