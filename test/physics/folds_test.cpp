// Bellows pressed until their folds lie on each other: by brute force, no node is in the material
// of another part.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "vacuum_gripper_sim/config/cup_file.h"
#include "vacuum_gripper_sim/core/cup_faces.h"
#include "vacuum_gripper_sim/core/gmsh_reader.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Vector3d;

/// What a fold may be inside another one at the end of a step: the solver's slack. [m]
constexpr double kSlack = 2e-5;

/// How deep a node is in the material of elements that are not its own; 0: it is in none. [m]
class Depths {
 public:
  explicit Depths(const TetMesh& mesh) : mesh_(mesh), faces_(mesh) {
    for (Eigen::Index i = 0; i < faces_.triangles().size(); ++i) {
      nodes_.push_back(faces_.triangles().data()[i]);
    }
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  }
  double Deepest(const Eigen::Matrix3Xd& x_W) {
    faces_.Update(x_W);
    double deepest = 0.0;
    for (Eigen::Index e = 0; e < mesh_.elements.cols(); ++e) {
      const auto corner = [&](int k) -> Vector3d { return x_W.col(mesh_.elements(k, e)); };
      Eigen::AlignedBox3d box(corner(0));
      for (int k = 1; k < 4; ++k) box.extend(corner(k));
      Eigen::Matrix3d edges;
      edges << corner(1) - corner(0), corner(2) - corner(0), corner(3) - corner(0);
      const Eigen::Matrix3d inverse = edges.inverse();
      for (const int node : nodes_) {
        const Vector3d p = x_W.col(node);
        if (!box.contains(p) || (mesh_.elements.col(e).array() == node).any()) continue;
        const Vector3d weights = inverse * (p - corner(0));
        if (weights.minCoeff() < 0.0 || weights.sum() > 1.0) continue;
        deepest = std::max(deepest, DepthOf(node, p));
      }
    }
    return deepest;
  }

 private:
  double DepthOf(int node, const Vector3d& p) const {
    const auto is_another = [&](int t) {
      return (faces_.triangles().col(t).array() != node).all();
    };
    return std::abs(faces_.Nearest(p, 1e-2, is_another)->distance);
  }

  TetMesh mesh_;
  CupFaces faces_;
  std::vector<int> nodes_;  // of the boundary
};

TEST(Folds, PressedFarTheyDoNotPassThroughEachOther) {
  const std::string cups = VACUUM_GRIPPER_SOURCE_DIR "/config/cups";
  const Cup cup = ReadCup(YAML::Node("bellows_25_linear"), cups, cups);
  const TetMesh mesh = ReadGmsh(cup.mesh_file);
  SimulatorParameters parameters;
  parameters.gravity.setZero();
  parameters.material = cup.material;
  parameters.damping = cup.damping;
  const double length = mesh.nodes.row(2).maxCoeff();  // from lip to mount
  const auto pose_at = [&](double lip) {
    Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
    X_WM.linear() = Vector3d(1.0, -1.0, -1.0).asDiagonal();
    X_WM.translation().z() = length + lip;
    return X_WM;
  };
  Simulator simulator(mesh, parameters, pose_at(1e-4));
  simulator.SetObjects({FixedObject(RigidSurface{"plate", Plane{}})});
  Depths depths(mesh);
  EXPECT_EQ(depths.Deepest(simulator.result().x_W), 0.0);

  constexpr double kPress = 13e-3;  // folds meet at 11 [m]
  int undone_steps = 0;
  double deepest = 0.0;
  double most_on_folds = 0.0;  // N
  for (double lip = 0.0; lip > -kPress; lip -= 0.02 * parameters.time_step) {
    const StepResult& result = simulator.Step({pose_at(lip), 0.0});
    undone_steps += result.outcome == StepOutcome::kOk ? 0 : 1;
    deepest = std::max(deepest, depths.Deepest(result.x_W));
    most_on_folds = std::max(most_on_folds, result.fold_force);
    EXPECT_NEAR(result.contact_force, -result.objects[0].force_W.z(), 1e-9);  // of the plate alone
  }
  RecordProperty("deepest", std::to_string(deepest));
  RecordProperty("most_on_folds", std::to_string(most_on_folds));
  EXPECT_GT(most_on_folds, 0.1);  // folds did meet
  EXPECT_LT(deepest, 1.5 * kSlack);
  EXPECT_EQ(undone_steps, 0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
