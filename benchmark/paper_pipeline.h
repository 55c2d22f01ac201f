#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/classifier.h"
#include "vacuum_gripper_sim/core/contact.h"
#include "vacuum_gripper_sim/core/elastic_body.h"
#include "vacuum_gripper_sim/core/implicit_euler.h"
#include "vacuum_gripper_sim/core/parameters.h"
#include "vacuum_gripper_sim/core/rigid_surface.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/// Where a step starts, what it is asked to reach, and where the Simulator's step of it ended.
struct StepProblem {
  Eigen::Matrix3Xd x_W, v_W;  ///< At the start, 3 by #nodes. [m], [m/s]
  Eigen::Isometry3d X_WM;     ///< Of the mount at the end.
  double pressure{0.0};       ///< lambda_p. [Pa]
  std::vector<bool> wet;      ///< The cavity points that it acts on.
  Eigen::Matrix3Xd x_end_W;   ///< 3 by #nodes. [m]
};

/// Thread-CPU time of the parts of a step. [s]
struct PaperTimings {
  double assembly{0.0};
  double factorization{0.0};  ///< The paper's runs on a second thread.
  double free_motion{0.0};
  double classification{0.0};  ///< With the narrow phase.
  double delassus{0.0};
  double solve{0.0};
  double correction{0.0};
};

/** A step by the means of [Bernardin, Sec. III and IV], for comparison; made of this library's
 parts, so that only the method differs from Simulator::Step():

 1) free motion by one iteration of preconditioned conjugate gradients,
 2) every surface point that is nearer than .5 mm when the step begins, or that the free motion
 brings there, is a constraint (under a pull the free motion alone, which knows no pressure, lifts
 the lip off the plate: without constraints the step would be cheap and end millimetres away); the
 classifier runs on the gaps of the free motion, 3) H_c of these and H_p of the wet points, 4) W =
 h^2 H A^-1 H^T by a solve with the factorisation for each column, the pressure's included;
 Gauss-Seidel from zero, 100 sweeps, 5) correction by one more solve.

 What the paper spends beyond that is left out, which is in its favour: the pressure and the wet
 points are those that the Simulator found, so one contact solve is enough instead of one before and
 one after a ramp; the factorisation, which its second thread and graphics card make, is exact, and
 is timed apart. */
class PaperPipeline {
 public:
  /// Which points of the surface may be in contact: SOFA's collision models of points alone, or
  /// also of lines, which is what makes several hundred constraints of 704 linear elements.
  enum class Points { kNodes, kNodesAndEdges };

  /// @param mesh At rest.
  PaperPipeline(const TetMesh& mesh, const SimulatorParameters& parameters,
                std::vector<RigidSurface> surfaces, Points points);

  /// @returns Positions at the end, 3 by #nodes. [m] @throws std::runtime_error if A is not
  /// positive definite. @param[in,out] timings Adds to each.
  Eigen::Matrix3Xd Step(const StepProblem& problem, PaperTimings* timings);

  int num_constraints() const { return num_constraints_; }  ///< Contacts of the last step.

 private:
  Eigen::VectorXd FreeMotion(const Eigen::VectorXd& b);
  Eigen::VectorXd PressureRow(const StepProblem& problem) const;
  Eigen::Matrix3Xd PointPositions(const Eigen::Matrix3Xd& x_W) const;
  void AddImpulse(const NodeContact& contact, double impulse, Eigen::VectorXd* b) const;
  double NormalVelocity(const NodeContact& contact, const Eigen::VectorXd& dv) const;

  SimulatorParameters parameters_;
  std::vector<RigidSurface> surfaces_;
  Eigen::Matrix3Xd rest_M_;  // in the mount frame [m]
  CavitySurface cavity_;
  ElasticBody body_;
  ImplicitEuler system_;
  SparseCholesky factorization_;
  std::vector<std::array<int, 2>> points_;  // halfway between two free nodes; equal: at a node
  std::vector<int> point_numbers_;          // 0, 1, ...
  Classification classification_;           // of the free motion
  int num_constraints_{0};
};

}  // namespace vacuum_gripper_sim
