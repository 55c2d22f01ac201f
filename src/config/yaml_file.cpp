#include "vacuum_gripper_sim/config/yaml_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "yaml_text.h"

namespace vacuum_gripper_sim {

std::string ReadTextFile(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw std::invalid_argument(path + ": no such file");
  if (!std::filesystem::is_regular_file(status)) {
    throw std::invalid_argument(path + ": not a regular file");
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file.peek() != std::ifstream::traits_type::eof()) text << file.rdbuf();
  if (file.bad() || !file.is_open()) throw std::invalid_argument(path + ": cannot be read");
  return text.str();
}

YAML::Node ReadYamlFile(const std::string& path) {
  const YAML::Node node = ParseYaml(ReadTextFile(path), path);
  if (!node.IsMap()) {
    throw std::invalid_argument(path + ": the document is " + Describe(node) +
                                "; expected a map of keys");
  }
  return node;
}

YAML::Node ParseYaml(const std::string& text, const std::string& source) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& e) {
    const std::string where = e.mark.is_null() ? ""
                                               : std::to_string(e.mark.line + 1) + ":" +
                                                     std::to_string(e.mark.column + 1) + ":";
    throw std::invalid_argument(source + ":" + where + " not valid YAML: " + e.msg);
  }
}

}  // namespace vacuum_gripper_sim
