#include "vacuum_gripper_sim/core/surface_sighting.h"

#include <memory>
#include <variant>

namespace vacuum_gripper_sim {
namespace {

/// How deep behind a sheet a point still belongs to its front, and the other way round. [m]
constexpr double kSideMemory = 5e-3;

Eigen::Vector3d InShape(const RigidSurface& surface, const Eigen::Vector3d& p_F) {
  return surface.X_FS.linear().transpose() * (p_F - surface.X_FS.translation());
}

SurfaceDistance InFrame(const RigidSurface& surface, SurfaceDistance seen) {
  seen.normal = surface.X_FS.linear() * seen.normal;
  return seen;
}

}  // namespace

SurfaceDistance SurfaceSighting::BeginStep(const Shape& shape, const Eigen::Vector3d& p_S,
                                           double reach) {
  const SurfaceDistance seen = Look(shape, p_S, reach);
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (mesh == nullptr) return seen;
  if (p_S_ != p_S) return seen;  // no nearer to the sheet than when it was seen: on the same side
  if (seen.distance >= reach) side_ = 0;
  if (!Settle(**mesh)) return seen;
  const MeshPoint point = (*mesh)->SeenFrom(side_, point_);
  return seen_ = {point.distance, point.normal};
}

SurfaceDistance SurfaceSighting::Look(const Shape& shape, const Eigen::Vector3d& p_S,
                                      double reach) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh == nullptr ? Distance(shape, p_S) : LookAtMesh(**mesh, p_S, reach);
}

SurfaceDistance SurfaceSighting::BeginStep(const RigidSurface& surface, const Eigen::Vector3d& p_F,
                                           double reach) {
  return InFrame(surface, BeginStep(surface.shape, InShape(surface, p_F), reach));
}

SurfaceDistance SurfaceSighting::Look(const RigidSurface& surface, const Eigen::Vector3d& p_F) {
  return InFrame(surface, Look(surface.shape, InShape(surface, p_F)));
}

SurfaceDistance SurfaceSighting::LookAtMesh(const TriangleMesh& mesh, const Eigen::Vector3d& p_S,
                                            double reach) {
  if (has_seen_) {
    if (p_S == p_S_) return seen_;
    const double least = seen_.distance - (p_S - p_S_).norm();
    if (least >= reach) return {least, seen_.normal};
  }
  point_ = *mesh.Nearest(p_S, kExact, has_seen_ ? point_.triangle : TriangleMesh::kNoHint);
  const MeshPoint point = mesh.SeenFrom(side_, point_);
  has_seen_ = true;
  p_S_ = p_S;
  return seen_ = {point.distance, point.normal};
}

/// Decides to which side the point belongs. @returns true if that is news.
bool SurfaceSighting::Settle(const TriangleMesh& mesh) {
  const int before = side_;
  const int shell = mesh.shell(point_.triangle);
  const int here = point_.distance < 0.0 ? -1 : 1;
  if (side_ == 0 || shell != shell_) side_ = here;
  shell_ = shell;
  const bool past_border = point_.rim_distance > 0.0;
  const double below = -side_ * (past_border ? point_.rim_height() : point_.distance);
  if (below > (past_border ? TriangleMesh::kBorderTolerance : kSideMemory)) side_ = here;
  return side_ != before;
}

}  // namespace vacuum_gripper_sim
