#include "scene_xml.h"

#include <cmath>
#include <locale>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

namespace vacuum_gripper_sim {
namespace {

using tinyxml2::XMLElement;

/// Empty if there is no such attribute.
std::string Attribute(const XMLElement* element, const char* name) {
  const char* value = element == nullptr ? nullptr : element->Attribute(name);
  return value == nullptr ? std::string() : value;
}

[[noreturn]] void Refuse(const std::string& link, const std::string& reason) {
  throw std::invalid_argument("scene: link " + link + ": " + reason);
}

/// A number of 0 or more. @param name What it is, for messages. @param text Null: nothing.
double ReadNotNegative(const std::string& link, const std::string& name, const char* text) {
  double value = 0.0;
  const bool is_number = text != nullptr && tinyxml2::XMLUtil::ToDouble(text, &value);
  if (is_number && std::isfinite(value) && value >= 0.0) return value;
  Refuse(link, name + " = " + (text == nullptr ? "nothing" : text) +
                   "; expected a finite number of 0 or more");
}

Eigen::Vector3d ReadPlace(const std::string& link, const std::string& text) {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  if (stream >> place.x() >> place.y() >> place.z() && (stream >> std::ws).eof()) return place;
  Refuse(link, "hole xyz = " + text + "; expected three numbers");
}

struct ParentJoint {
  std::string name, parent;
};

std::map<std::string, ParentJoint> ReadParents(const XMLElement* robot) {
  std::map<std::string, ParentJoint> parents;
  for (const XMLElement* joint = robot->FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const std::string child = Attribute(joint->FirstChildElement("child"), "link");
    if (child.empty()) continue;  // urdfdom says so
    const ParentJoint found{Attribute(joint, "name"),
                            Attribute(joint->FirstChildElement("parent"), "link")};
    const auto [entry, is_first] = parents.emplace(child, found);
    if (!is_first) {
      Refuse(child, "is the child of the joints " + entry->second.name + " and " + found.name +
                        "; expected only one");
    }
  }
  return parents;
}

}  // namespace

SceneXml::SceneXml(const std::string& xml) {
  document_.Parse(xml.c_str(), xml.size());
  if (!document_.Error()) robot_ = document_.FirstChildElement("robot");
}

void SceneXml::CheckTree() const {
  if (robot_ == nullptr) return;
  std::set<std::string> names;
  for (const XMLElement* link = robot_->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    const std::string name = Attribute(link, "name");
    if (!names.insert(name).second) Refuse(name, "there are two of this name; expected one");
  }
  const std::map<std::string, ParentJoint> parents = ReadParents(robot_);
  for (const std::string& name : names) {
    std::set<std::string> visited{name};
    for (auto up = parents.find(name); up != parents.end(); up = parents.find(up->second.parent)) {
      if (visited.insert(up->second.parent).second) continue;
      Refuse(up->second.parent,
             "is above itself, a cycle that joint " + up->second.name + " closes; expected a tree");
    }
  }
}

const XMLElement* SceneXml::FindCollision(const std::string& link, std::size_t collision) const {
  if (robot_ == nullptr) return nullptr;
  for (const XMLElement* element = robot_->FirstChildElement("link"); element != nullptr;
       element = element->NextSiblingElement("link")) {
    if (Attribute(element, "name") != link) continue;
    const XMLElement* shape = element->FirstChildElement("collision");
    for (std::size_t i = 0; i < collision && shape != nullptr; ++i) {
      shape = shape->NextSiblingElement("collision");
    }
    return shape;
  }
  return nullptr;
}

void SceneXml::ReadAir(const std::string& link, std::size_t collision,
                       RigidSurface* surface) const {
  const XMLElement* const shape = FindCollision(link, collision);
  if (shape == nullptr) return;
  if (const XMLElement* air = shape->FirstChildElement("air")) {
    if (const char* text = air->Attribute("roughness")) {
      surface->roughness = ReadNotNegative(link, "air roughness", text);
    }
    if (const char* text = air->Attribute("permeance")) {
      surface->permeance = ReadNotNegative(link, "air permeance", text);
    }
  }
  for (const XMLElement* element = shape->FirstChildElement("hole"); element != nullptr;
       element = element->NextSiblingElement("hole")) {
    SurfaceHole hole;
    hole.p_S = ReadPlace(link, Attribute(element, "xyz"));
    hole.area = ReadNotNegative(link, "hole area", element->Attribute("area"));
    surface->holes.push_back(hole);
  }
}

std::optional<double> SceneXml::Friction(const std::string& link, std::size_t collision) const {
  if (robot_ == nullptr) return std::nullopt;
  if (const XMLElement* shape = FindCollision(link, collision)) {
    const XMLElement* friction = shape->FirstChildElement("friction");
    if (friction != nullptr) return ReadNotNegative(link, "friction mu", friction->Attribute("mu"));
  }
  for (const XMLElement* element = robot_->FirstChildElement("gazebo"); element != nullptr;
       element = element->NextSiblingElement("gazebo")) {
    if (Attribute(element, "reference") != link) continue;
    const XMLElement* friction = element->FirstChildElement("mu1");
    if (friction != nullptr) return ReadNotNegative(link, "friction mu1", friction->GetText());
  }
  return std::nullopt;
}

}  // namespace vacuum_gripper_sim
