#include "paper_pipeline.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

#include "thread_clock.h"
#include "vacuum_gripper_sim/core/mcp_solver.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kAlarmDistance = 5e-4;  // m
constexpr double kOpenGap = 1e-4;        // m; only colours depend on it

ContactParameters PaperContact() {
  ContactParameters parameters;
  parameters.method = ContactSolverMethod::kGaussSeidel;
  parameters.tolerance = 1e-9;      // Sec. IV
  parameters.max_iterations = 100;  // Sec. IV
  return parameters;
}

}  // namespace

PaperPipeline::PaperPipeline(const TetMesh& mesh, const SimulatorParameters& parameters,
                             std::vector<RigidSurface> surfaces, Points points)
    : parameters_(parameters),
      surfaces_(std::move(surfaces)),
      rest_M_(MountFromRest(mesh) * mesh.nodes),
      cavity_(MakeCavitySurface(mesh)),
      body_(mesh, parameters.material),
      system_(body_, mesh.mount_nodes) {
  factorization_.Analyze(system_.matrix().pattern());
  std::set<std::array<int, 2>> chosen;
  const Eigen::MatrixXi& faces = mesh.boundary_faces;
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    for (Eigen::Index i = 0; i < faces.rows(); ++i) chosen.insert({faces(i, f), faces(i, f)});
    if (points == Points::kNodes || mesh.quadratic()) continue;  // a node on every edge anyway
    for (Eigen::Index i = 0; i < 3; ++i) {
      const int a = faces(i, f);
      const int b = faces((i + 1) % 3, f);
      chosen.insert({std::min(a, b), std::max(a, b)});
    }
  }
  std::copy_if(chosen.begin(), chosen.end(), std::back_inserter(points_), [&](const auto& ends) {
    return system_.FreeRow(ends[0]) >= 0 && system_.FreeRow(ends[1]) >= 0;
  });
  point_numbers_.resize(points_.size());
  std::iota(point_numbers_.begin(), point_numbers_.end(), 0);
}

/// 3 by #points_. [m]
Eigen::Matrix3Xd PaperPipeline::PointPositions(const Eigen::Matrix3Xd& x_W) const {
  Eigen::Matrix3Xd positions(3, static_cast<Eigen::Index>(points_.size()));
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    const auto& [a, b] = points_[static_cast<std::size_t>(i)];
    positions.col(i) = 0.5 * (x_W.col(a) + x_W.col(b));
  }
  return positions;
}

/// b += (row of H)^T impulse. @param impulse [N s]
void PaperPipeline::AddImpulse(const NodeContact& contact, double impulse,
                               Eigen::VectorXd* b) const {
  for (const int node : points_[static_cast<std::size_t>(contact.node)]) {
    b->segment<3>(system_.FreeRow(node)) += 0.5 * impulse * contact.normal;
  }
}

/// (row of H) dv. [m/s]
double PaperPipeline::NormalVelocity(const NodeContact& contact, const Eigen::VectorXd& dv) const {
  const auto& [a, b] = points_[static_cast<std::size_t>(contact.node)];
  return 0.5 *
         contact.normal.dot(dv.segment<3>(system_.FreeRow(a)) + dv.segment<3>(system_.FreeRow(b)));
}

/// One iteration of conjugate gradients from zero.
Eigen::VectorXd PaperPipeline::FreeMotion(const Eigen::VectorXd& b) {
  const Eigen::VectorXd z = factorization_.Solve(b);
  const Eigen::VectorXd Az = system_.Multiply(z);
  return (b.dot(z) / z.dot(Az)) * z;
}

Eigen::Matrix3Xd PaperPipeline::Step(const StepProblem& problem, PaperTimings* timings) {
  const double h = parameters_.time_step;
  const std::vector<int>& clamped = system_.clamped_nodes();
  Eigen::Matrix3Xd dv_c(3, static_cast<Eigen::Index>(clamped.size()));
  for (Eigen::Index i = 0; i < dv_c.cols(); ++i) {
    const int node = clamped[static_cast<std::size_t>(i)];
    const Eigen::Vector3d target_W = problem.X_WM * rest_M_.col(node);
    dv_c.col(i) = (target_W - problem.x_W.col(node)) / h - problem.v_W.col(node);
  }
  const auto end_positions = [&](const Eigen::VectorXd& dv_f) -> Eigen::Matrix3Xd {
    return problem.x_W + h * (problem.v_W + system_.Scatter(dv_f, dv_c));
  };

  // 1) Free motion.
  Eigen::VectorXd b;
  {
    const ThreadStopwatch stopwatch(&timings->assembly);
    system_.Linearize(problem.x_W, problem.v_W, h, parameters_.damping, parameters_.gravity);
    b = system_.FreeRightHandSide(dv_c);
  }
  {
    const ThreadStopwatch stopwatch(&timings->factorization);
    if (!factorization_.Factorize(system_.A_ff())) {
      throw std::runtime_error("A is not positive definite");
    }
  }
  Eigen::VectorXd dv_f;
  {
    const ThreadStopwatch stopwatch(&timings->free_motion);
    dv_f = FreeMotion(b);
  }
  const Eigen::Matrix3Xd x_free_W = end_positions(dv_f);

  // 2) Classification.
  std::vector<NodeContact> contacts;
  {
    const ThreadStopwatch stopwatch(&timings->classification);
    NarrowPhase narrow_phase;
    narrow_phase.Begin(surfaces_, point_numbers_, PointPositions(problem.x_W));
    const Eigen::Matrix3Xd points_free_W = PointPositions(x_free_W);
    for (int pair = 0; pair < narrow_phase.num_pairs(); ++pair) {
      const NodeContact contact = narrow_phase.Ahead(pair, points_free_W);
      const double nearest = std::min(narrow_phase.seen(pair).distance, contact.gap);
      if (nearest < kAlarmDistance) contacts.push_back(contact);
    }
    classification_ =
        Classify(cavity_, NearestDistances(surfaces_, cavity_.nodes, x_free_W), kOpenGap);
  }
  num_constraints_ = static_cast<int>(contacts.size());

  // 3), 4) H, a column of A^-1 H^T after the other, and W.
  const auto n = static_cast<Eigen::Index>(contacts.size());
  Eigen::VectorXd H_p;
  Eigen::MatrixXd W(n, n);
  Eigen::VectorXd delta(n);
  {
    const ThreadStopwatch stopwatch(&timings->delassus);
    for (Eigen::Index j = 0; j < n; ++j) {
      Eigen::VectorXd impulse = Eigen::VectorXd::Zero(b.size());
      AddImpulse(contacts[static_cast<std::size_t>(j)], h, &impulse);
      const Eigen::VectorXd dv = factorization_.Solve(impulse);
      for (Eigen::Index i = 0; i < n; ++i) {
        W(i, j) = h * NormalVelocity(contacts[static_cast<std::size_t>(i)], dv);
      }
    }
    H_p = PressureRow(problem);
    const Eigen::VectorXd dv = factorization_.Solve(h * H_p);
    for (Eigen::Index i = 0; i < n; ++i) {
      const NodeContact& contact = contacts[static_cast<std::size_t>(i)];
      delta(i) = contact.gap + h * NormalVelocity(contact, dv) * problem.pressure;
    }
  }
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(n);
  {
    const ThreadStopwatch stopwatch(&timings->solve);
    McpSolver().Solve(W, delta, PaperContact(), &lambda);
  }

  // 5) Motion correction.
  const ThreadStopwatch stopwatch(&timings->correction);
  Eigen::VectorXd impulse = h * problem.pressure * H_p;
  for (Eigen::Index i = 0; i < n; ++i) {
    AddImpulse(contacts[static_cast<std::size_t>(i)], h * lambda(i), &impulse);
  }
  dv_f += factorization_.Solve(impulse);
  return end_positions(dv_f);
}

/// Area vectors of the wet points at the step's start, by free row. [m^2]
Eigen::VectorXd PaperPipeline::PressureRow(const StepProblem& problem) const {
  const Eigen::Matrix3Xd area_vectors = PointAreaVectors(cavity_, problem.x_W);
  Eigen::Matrix3Xd row = Eigen::Matrix3Xd::Zero(3, problem.x_W.cols());
  for (std::size_t i = 0; i < problem.wet.size(); ++i) {
    if (problem.wet[i]) {
      row.col(cavity_.nodes[i]) = area_vectors.col(static_cast<Eigen::Index>(i));
    }
  }
  return system_.GatherFree(row);
}

}  // namespace vacuum_gripper_sim
