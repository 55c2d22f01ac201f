// Cantilever 100 x 10 x 10 mm of A20, clamped at x = 0, a dead force -z spread over its tip.
#include <gtest/gtest.h>

#include "validation/reference_case.h"
#include "validation/statics.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kSmallForce = 8.45e-4;       // Euler-Bernoulli: 1 mm [N]
constexpr double kLargeForce = 0.0563333333;  // F L^2 / (E I) = 2 [N]

/// Mean displacement of the tip's nodes. [m]
Eigen::Vector3d Tip(const TetMesh& mesh, double force, int increments,
                    MaterialModel model = MaterialModel::kCorotational) {
  Statics statics(mesh, ReferenceA20(model), mesh.mount_nodes);
  statics.SetDeadLoad(UniformTraction(mesh, mesh.cavity_faces, Eigen::Vector3d(0.0, 0.0, -force)));
  const Statics::Solution solution = statics.Solve(increments);
  EXPECT_NEAR(solution.support.z(), force, 1e-5 * force);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    if (mesh.nodes(0, n) < 0.1 - 1e-9) continue;
    sum += solution.x.col(n) - mesh.nodes.col(n);
    ++count;
  }
  return sum / count;
}

/// The reference's small load is a linear analysis: a hundredth of it here, times a hundred. [m]
double LinearTip(const TetMesh& mesh) { return 100.0 * Tip(mesh, 0.01 * kSmallForce, 1).z(); }

TEST(Beam, LinearElementsAgainstTheSameMesh) {
  const TetMesh mesh = LoadReferenceMesh("beam_linear");
  Compare("beam linear, small: uz [m]", LinearTip(mesh), -3.673588e-4, 1e-4);
  const Eigen::Vector3d large = Tip(mesh, kLargeForce, 4);
  Compare("beam linear, large: uz [m]", large.z(), {-0.0232452, -0.0231014}, 0.02);
}

TEST(Beam, QuadraticElementsAgainstTheConvergedSolution) {
  const TetMesh mesh = LoadReferenceMesh("beam_quadratic");
  const double small = LinearTip(mesh);
  const Eigen::Vector3d large = Tip(mesh, kLargeForce, 5);
  Compare("beam quadratic, small: uz [m]", small, -9.893935e-4, 0.03);
  Compare("beam quadratic, large: uz [m]", large.z(), {-0.0492012, -0.0492548}, 0.03);
  Compare("beam quadratic, large: ux [m]", large.x(), {-0.0159830, -0.0158302}, 0.03);
  // The same mesh in CalculiX: what is left is the material.
  Compare("beam quadratic, same mesh, small: uz [m]", small, -9.826295e-4, 1e-4);
  Compare("beam quadratic, same mesh, large: uz [m]", large.z(), {-0.0489503, -0.0490030}, 0.02);
}

TEST(Beam, NeoHookeanAgainstNeoHookean) {
  constexpr MaterialModel kModel = MaterialModel::kNeoHookean;
  const Eigen::Vector3d linear = Tip(LoadReferenceMesh("beam_linear"), kLargeForce, 4, kModel);
  Compare("beam linear nh, large: uz [m]", linear.z(), -0.0231014, 0.02);
  const Eigen::Vector3d large = Tip(LoadReferenceMesh("beam_quadratic"), kLargeForce, 5, kModel);
  Compare("beam quadratic nh, large: uz [m]", large.z(), -0.0492548, 0.03);
  Compare("beam quadratic nh, large: ux [m]", large.x(), -0.0158302, 0.03);
  Compare("beam quadratic nh, same mesh, large: uz [m]", large.z(), -0.0490030, 0.02);
}

}  // namespace
}  // namespace vacuum_gripper_sim
