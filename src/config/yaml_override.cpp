#include "vacuum_gripper_sim/config/yaml_override.h"

#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "vacuum_gripper_sim/config/yaml_file.h"
#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

std::vector<std::string> SplitPath(const std::string& path) {
  std::vector<std::string> keys(1);
  for (const char c : path) {
    if (c == '.') {
      keys.emplace_back();
    } else {
      keys.back() += c;
    }
  }
  return keys;
}

std::size_t ToIndex(const std::string& key, std::size_t size, const std::string& path) {
  const bool digits = key.find_first_not_of("0123456789") == std::string::npos && key.size() < 9;
  const std::size_t index = digits ? std::stoul(key) : size;
  if (index < size) return index;
  throw std::invalid_argument("--set " + path + ": " + key + " is no index of a list of " +
                              std::to_string(size) + "; expected 0 to " + std::to_string(size - 1));
}

// Nodes are handles: a recursion instead of a loop, since assigning to a handle in a loop would
// overwrite the document.
void Set(YAML::Node node, const std::vector<std::string>& keys, std::size_t depth,
         const Override& o) {
  const std::string& key = keys[depth];
  const bool last = depth + 1 == keys.size();
  if (node.IsSequence()) {
    if (node.size() == 0) {
      throw std::invalid_argument("--set " + o.path + ": the list above " + key + " is empty");
    }
    const std::size_t index = ToIndex(key, node.size(), o.path);
    if (last) {
      node[index] = o.value;
    } else {
      Set(node[index], keys, depth + 1, o);
    }
    return;
  }
  if (node.IsScalar()) {
    throw std::invalid_argument("--set " + o.path + ": there is no key " + key +
                                " below the value " + Describe(node));
  }
  if (last) {
    node[key] = o.value;
    return;
  }
  const YAML::Node child = std::as_const(node)[key];
  if (!child.IsDefined() || child.IsNull()) node[key] = YAML::Node(YAML::NodeType::Map);
  Set(node[key], keys, depth + 1, o);
}

}  // namespace

Override ParseOverride(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string path = assignment.substr(0, equals);
  const bool empty_key = path.empty() || path.front() == '.' || path.back() == '.' ||
                         path.find("..") != std::string::npos;
  if (equals == std::string::npos || empty_key) {
    throw std::invalid_argument("--set " + assignment + "; expected key.path=value");
  }
  return {path, ParseYaml(assignment.substr(equals + 1), "--set " + path)};
}

void ApplyOverride(const Override& override_, const YAML::Node& root) {
  Set(root, SplitPath(override_.path), 0, override_);
}

}  // namespace vacuum_gripper_sim
