#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/step_result.h"
#include "vacuum_gripper_sim/core/tet_mesh.h"

namespace vacuum_gripper_sim {

/** Draws the deformed cup: its skin in silicone grey outside and in the zones' colours inside, the
 classified points, and the wrench's force as an arrow.

 rviz lights no triangle that has colours per vertex, so light and shade are part of the colours.
 The zones shine through the wall: where the cup is thin its outer skin takes on some of the colour
 of the nearest inner point, because from above the inner surface itself cannot be seen. */
class MarkerPainter {
 public:
  MarkerPainter(const TetMesh& mesh, const CavitySurface& cavity);

  /// @param header Of `world_frame`.
  visualization_msgs::MarkerArray Paint(const StepResult& result,
                                        const std_msgs::Header& header) const;

 private:
  visualization_msgs::Marker PaintSkin(const StepResult& result,
                                       const std_msgs::Header& header) const;
  visualization_msgs::Marker PaintZones(const StepResult& result,
                                        const std_msgs::Header& header) const;

  std::vector<int> cavity_nodes_;  // Mesh node of each cavity point.
  Eigen::Matrix3Xi triangles_;     // Skin, 3 by #triangles; mesh nodes, outwards.
  std::vector<bool> inner_;        // Of each triangle: part of the cavity surface?
  std::vector<int> tint_point_;    // Of each mesh node: the cavity point it is coloured by, or -1.
  std::vector<double> tint_;       // How much of that colour an outer triangle shows. [0, 1]
};

}  // namespace vacuum_gripper_sim
