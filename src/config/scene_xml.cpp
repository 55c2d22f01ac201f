#include "scene_xml.h"

#include <cmath>
#include <map>
#include <set>
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

double ReadFriction(const std::string& link, const char* name, const char* text) {
  double friction = 0.0;
  const bool is_number = text != nullptr && tinyxml2::XMLUtil::ToDouble(text, &friction);
  if (is_number && std::isfinite(friction) && friction >= 0.0) return friction;
  Refuse(link, std::string("friction ") + name + " = " + (text == nullptr ? "nothing" : text) +
                   "; expected a finite number of 0 or more");
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

std::optional<double> SceneXml::Friction(const std::string& link, std::size_t collision) const {
  if (robot_ == nullptr) return std::nullopt;
  for (const XMLElement* element = robot_->FirstChildElement("link"); element != nullptr;
       element = element->NextSiblingElement("link")) {
    if (Attribute(element, "name") != link) continue;
    const XMLElement* shape = element->FirstChildElement("collision");
    for (std::size_t i = 0; i < collision && shape != nullptr; ++i) {
      shape = shape->NextSiblingElement("collision");
    }
    const XMLElement* friction = shape == nullptr ? nullptr : shape->FirstChildElement("friction");
    if (friction != nullptr) return ReadFriction(link, "mu", friction->Attribute("mu"));
  }
  for (const XMLElement* element = robot_->FirstChildElement("gazebo"); element != nullptr;
       element = element->NextSiblingElement("gazebo")) {
    if (Attribute(element, "reference") != link) continue;
    const XMLElement* friction = element->FirstChildElement("mu1");
    if (friction != nullptr) return ReadFriction(link, "mu1", friction->GetText());
  }
  return std::nullopt;
}

}  // namespace vacuum_gripper_sim
