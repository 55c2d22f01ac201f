#pragma once

#include <Eigen/Core>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

/// The finest gap that counts as a way out where the lip has no curvature to derive it from: about
/// the roughness of a moulded silicone lip. [m]
constexpr double kFinestSealGap = 1e-5;

/** How far a lip that touches all round can seem to stand off, because it is known at nodes only.

 Where the lip rolls, its true line of contact runs between two neighbouring nodes. Over an edge of
 length L whose end normals enclose the angle a, an arc stands off its chord by up to its sagitta
 L a / 8, and so do nodes on either side of the line from the surface. The largest over the edges of
 the cavity along which the rest surface is convex, which is the lip; the dome's inside is concave.

 @param rest Rest positions of all mesh nodes, 3 by #nodes. [m]
 @returns [m]; 0 when no edge is convex (a flat pad). */
double LipSagitta(const CavitySurface& cavity, const Eigen::Matrix3Xd& rest);

/** Fills in the gaps that the user left to the mesh: the larger of `sagitta` and kFinestSealGap,
 where this leaves close_gap <= open_gap, otherwise the gap that was given. */
SealParameters ResolveSealGaps(SealParameters seal, double sagitta);

}  // namespace vacuum_gripper_sim
