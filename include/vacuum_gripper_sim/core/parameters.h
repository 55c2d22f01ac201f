#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/vacuum_parameters.h"

namespace vacuum_gripper_sim {

/// How stress follows from deformation; material_model.h has the equations.
enum class MaterialModel { kCorotational, kNeoHookean };

/// Silicone as an isotropic elastic material.
struct Material {
  double young_modulus{338000.0};  ///< [Pa] > 0
  double poisson_ratio{0.45};      ///< [-] 0 <= nu < 0.5
  double density{1080.0};          ///< [kg/m^3] > 0
  MaterialModel model{MaterialModel::kCorotational};
};

/// Rayleigh damping D = mass * M + stiffness * K.
struct RayleighDamping {
  double mass{0.0};        ///< alpha [1/s] >= 0
  double stiffness{2e-3};  ///< beta [s] >= 0
};

enum class LinearSolverMethod { kDirect, kConjugateGradient, kAsynchronous };

/// Of the numbers of a factorisation.
enum class Precision { kDouble, kSingle };

/// How the sparse systems with A are solved.
struct LinearSolverParameters {
  LinearSolverMethod method{LinearSolverMethod::kDirect};
  Precision precision{Precision::kSingle};  ///< Of factorisations. kSingle: twice as fast and half
                                            ///< the memory; iterations make up for it.
  double tolerance{2e-6};                   ///< CG: bound on |r| / |b|, or over what the cup's
                                            ///< weight makes of |b| if that is more. [-] > 0
  double position_tolerance{4e-8};          ///< CG: a correction by which no node and no body moves
                                    ///< farther along any axis is the last one, too. [m] 0 .. 1e-5
  int max_iterations{10};     ///< CG: a solve that needs more has A factorised; about what that
                              ///< costs, in iterations. >= 1
  int refactor_interval{20};  ///< Steps after which a factorisation is old, if they iterate. >= 1
  int threads{1};  ///< That share a step's factorisation, W and iterations; the numbers are the
                   ///< same with any. 1 .. 16
};

enum class ContactSolverMethod { kGaussSeidel, kActiveSet };

/// How the mixed complementarity problem is solved.
struct ContactParameters {
  ContactSolverMethod method{ContactSolverMethod::kActiveSet};
  double tolerance{1e-9};            ///< Bound on the complementarity residual. [m] > 0
  double acceptable_residual{1e-6};  ///< A step that ends above this is undone. [m] >= tolerance
  int max_iterations{100};           ///< Gauss-Seidel sweeps or active-set changes. >= 1
  double relaxation{1.0};            ///< Gauss-Seidel: over-relaxation factor, in (0, 2). [-]
  double alarm_distance{2e-5};       ///< Nodes that would end a step nearer to a surface than this
                                ///< at their velocity, and those under load, are candidates; where
                                ///< others pass it, all that come as near are added. [m] > 0
};

/// When the cavity counts as airtight.
struct SealParameters {
  /// Sealed when the bottleneck gap falls below close_gap, lost when it rises above open_gap.
  /// [m] > 0, close_gap <= open_gap. Not set: derived from the mesh, see ResolveSealGaps().
  std::optional<double> close_gap;
  std::optional<double> open_gap;
  int max_rounds{1};       ///< Reclassifications within a step with a seal. >= 1
  int ramp_increments{4};  ///< Pressure increments of a step without an earlier seal. >= 1
};

/// The pressure regulator.
struct RegulatorParameters {
  double default_pressure{-6000.0};  ///< Set-point of "on", gauge. [Pa] min_pressure .. 0
  double min_pressure{-90000.0};     ///< Lowest set-point accepted, gauge. [Pa] < 0
  double ramp_rate{100000.0};        ///< How fast the cavity follows the set-point. [Pa/s] > 0
};

/// One of a gripper's equal cups.
struct CupMount {
  std::string name;  ///< For people and topics; not empty where there are several, each its own.
  /// Pose of the cup's own mount C in the gripper's M, z along suction as there.
  Eigen::Isometry3d X_MC{Eigen::Isometry3d::Identity()};
};

/// Everything the Simulator needs besides mesh, surfaces and commands.
struct SimulatorParameters {
  double time_step{0.01};                    ///< h [s] > 0
  std::vector<CupMount> cups{CupMount()};    ///< At least one.
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< World frame. [m/s^2]
  Material material;
  RayleighDamping damping;
  LinearSolverParameters linear_solver;
  ContactParameters contact;
  SealParameters seal;
  RegulatorParameters regulator;
  VacuumParameters vacuum;
};

/** Checks every number.
 @throws std::invalid_argument naming the field by its dotted YAML path (`cup.young_modulus`,
   `seal.open_gap`), its value and what is allowed. */
void Validate(const SimulatorParameters& parameters);

}  // namespace vacuum_gripper_sim
