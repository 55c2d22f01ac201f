#include "vacuum_gripper_sim/config/cup_list.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <stdexcept>

#include "vacuum_gripper_sim/config/parameter_reader.h"
#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Topics and frames are named after it. http://wiki.ros.org/Names
bool IsBaseName(const std::string& text) {
  return !text.empty() && IsLetter(text.front()) &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return IsLetter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

CupMount ReadCupMount(const YAML::Node& node, const std::string& path) {
  ParameterReader reader(node, path);
  CupMount cup;
  cup.name = reader.GetString("name");
  if (!IsBaseName(cup.name)) {
    throw std::invalid_argument(reader.Name("name") + " = '" + cup.name +
                                "'; expected a letter, then letters, digits and underscores");
  }
  cup.X_MC.translation() = reader.GetVector3("position");
  cup.X_MC.linear() =
      reader.GetRotation("orientation", Eigen::Quaterniond::Identity()).toRotationMatrix();
  reader.CheckNoUnknownKeys();
  return cup;
}

}  // namespace

std::vector<CupMount> ReadCupMounts(const YAML::Node& node, const std::string& name) {
  if (!node.IsSequence() || node.size() == 0) {
    throw std::invalid_argument(name + " = " + Describe(node) +
                                "; expected a list of one cup or more");
  }
  std::vector<CupMount> cups;
  cups.reserve(node.size());
  std::set<std::string> names;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const std::string path = name + "." + std::to_string(i);
    cups.push_back(ReadCupMount(node[i], path));
    if (!names.insert(cups.back().name).second) {
      throw std::invalid_argument(path + ".name = '" + cups.back().name +
                                  "' is another cup's; expected names of their own");
    }
  }
  return cups;
}

}  // namespace vacuum_gripper_sim
