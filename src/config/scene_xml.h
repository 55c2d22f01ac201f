#pragma once

#include <tinyxml2.h>

#include <cstddef>
#include <optional>
#include <string>

#include "vacuum_gripper_sim/core/rigid_surface.h"

namespace vacuum_gripper_sim {

/** What urdfdom passes over in a URDF: friction, what air finds, and links that hang together
 in no tree. A text
 that is no URDF at all has nothing of either; urdfdom says what is wrong with it. */
class SceneXml {
 public:
  /// @param xml Must be parsed by urdfdom too.
  explicit SceneXml(const std::string& xml);

  /// @throws std::invalid_argument naming the link: two of one name, one with two parents, a cycle.
  void CheckTree() const;

  /** Coulomb's mu of a link's collision element, as `<friction mu="0.5"/>` in that element says,
   else as Gazebo has it for the link: `<gazebo reference="LINK"><mu1>0.5</mu1></gazebo>`.
   @param collision Its number in the link.
   @throws std::invalid_argument naming link, value and what is allowed. */
  std::optional<double> Friction(const std::string& link, std::size_t collision) const;

  /** Adds what air finds of a collision element to its surface: roughness and permeance of
   `<air roughness="2.0e-6" permeance="1.0e-9"/>`, holes of `<hole xyz="0 0 0" area="1.0e-6"/>`.
   @throws std::invalid_argument naming link, value and what is allowed. */
  void ReadAir(const std::string& link, std::size_t collision, RigidSurface* surface) const;

 private:
  /// Null if there is none.
  const tinyxml2::XMLElement* FindCollision(const std::string& link, std::size_t collision) const;

  tinyxml2::XMLDocument document_;
  const tinyxml2::XMLElement* robot_{nullptr};  // null: no URDF
};

}  // namespace vacuum_gripper_sim
