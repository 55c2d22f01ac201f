#include "vacuum_gripper_sim/config/parameter_reader.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

#include "yaml_text.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kUnitTolerance = 1e-3;  // as for pose commands

[[noreturn]] void Refuse(const std::string& name, const YAML::Node& value,
                         const std::string& expected) {
  if (!value.IsDefined()) {
    throw std::invalid_argument(name + " is not set; expected " + expected);
  }
  if (value.IsNull()) {
    throw std::invalid_argument(name + " has no value; expected " + expected);
  }
  throw std::invalid_argument(name + " = " + Describe(value) +
                              (value.IsScalar() && IsQuoted(value) ? " (text)" : "") +
                              "; expected " + expected);
}

double ToDouble(const YAML::Node& value, const std::string& name) {
  if (!value.IsDefined() || !value.IsScalar()) Refuse(name, value, "a number");
  double number = 0.0;
  if (!ParseDouble(value.Scalar(), &number)) Refuse(name, value, "a number");
  if (IsQuoted(value)) {
    // What YAML 1.1 makes of 593.0e3; a wrong type that looks right needs more words than others.
    Refuse(name, value,
           "a number: not quoted, an exponent with its sign and a point in front of it "
           "(593.0e+3)");
  }
  if (!std::isfinite(number)) Refuse(name, value, "a finite number");
  return number;
}

}  // namespace

ParameterReader::ParameterReader(const YAML::Node& node, std::string path)
    : node_(node.IsDefined() ? node : YAML::Node()), path_(std::move(path)) {
  if (node_.IsNull()) return;
  if (!node_.IsMap()) Refuse(path_.empty() ? "the document" : path_, node_, "a map of keys");
  std::set<std::string> keys;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) Refuse(Name(Describe(entry.first)), entry.second, "a plain key");
    // yaml-cpp keeps both and reads the first: one of them would be ignored in silence.
    if (!keys.insert(entry.first.Scalar()).second) {
      throw std::invalid_argument(Name(entry.first.Scalar()) + " is set twice; expected once");
    }
  }
}

bool ParameterReader::Has(const std::string& key) const { return node_[key].IsDefined(); }

std::string ParameterReader::Name(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

YAML::Node ParameterReader::GetNode(const std::string& key) {
  known_.insert(key);
  const YAML::Node value = std::as_const(node_)[key];
  return value.IsDefined() ? value : YAML::Node();
}

ParameterReader ParameterReader::GetMap(const std::string& key) {
  return ParameterReader(GetNode(key), Name(key));
}

double ParameterReader::GetDouble(const std::string& key) {
  known_.insert(key);
  return ToDouble(std::as_const(node_)[key], Name(key));
}

double ParameterReader::GetDouble(const std::string& key, double default_value) {
  known_.insert(key);
  return Has(key) ? GetDouble(key) : default_value;
}

int ParameterReader::GetInt(const std::string& key) {
  known_.insert(key);
  const YAML::Node value = std::as_const(node_)[key];
  const std::string expected = "a whole number";
  if (!value.IsDefined() || !value.IsScalar() || IsQuoted(value)) {
    Refuse(Name(key), value, expected);
  }
  double number = 0.0;
  if (value.Scalar().find_first_of(".eE") != std::string::npos ||
      !ParseDouble(value.Scalar(), &number)) {
    Refuse(Name(key), value, expected);
  }
  if (std::abs(number) > std::numeric_limits<int>::max()) {
    Refuse(Name(key), value, expected + " of at most 2147483647");
  }
  return static_cast<int>(number);
}

int ParameterReader::GetInt(const std::string& key, int default_value) {
  known_.insert(key);
  return Has(key) ? GetInt(key) : default_value;
}

bool ParameterReader::GetBool(const std::string& key, bool default_value) {
  known_.insert(key);
  if (!Has(key)) return default_value;
  const YAML::Node value = std::as_const(node_)[key];
  bool result = default_value;
  if (!value.IsScalar() || IsQuoted(value) || !YAML::convert<bool>::decode(value, result)) {
    Refuse(Name(key), value, "true or false");
  }
  return result;
}

std::string ParameterReader::GetString(const std::string& key) {
  known_.insert(key);
  const YAML::Node value = std::as_const(node_)[key];
  if (!value.IsDefined() || !value.IsScalar()) Refuse(Name(key), value, "text");
  return value.Scalar();
}

std::string ParameterReader::GetString(const std::string& key, const std::string& default_value) {
  known_.insert(key);
  return Has(key) ? GetString(key) : default_value;
}

std::string ParameterReader::GetChoice(const std::string& key,
                                       const std::vector<std::string>& allowed,
                                       const std::string& default_value) {
  known_.insert(key);
  if (!Has(key)) return default_value;
  const YAML::Node value = std::as_const(node_)[key];
  std::string expected;
  for (const std::string& choice : allowed) {
    if (value.IsScalar() && value.Scalar() == choice) return choice;
    expected += (expected.empty() ? "" : " or ") + choice;
  }
  Refuse(Name(key), value, expected);
}

Eigen::Vector3d ParameterReader::GetVector3(const std::string& key) {
  known_.insert(key);
  const YAML::Node value = std::as_const(node_)[key];
  if (!value.IsDefined() || !value.IsSequence() || value.size() != 3) {
    Refuse(Name(key), value, "a list of 3 numbers");
  }
  Eigen::Vector3d result;
  for (std::size_t i = 0; i < 3; ++i) {
    result(static_cast<Eigen::Index>(i)) = ToDouble(value[i], Name(key) + "." + std::to_string(i));
  }
  return result;
}

Eigen::Vector3d ParameterReader::GetVector3(const std::string& key,
                                            const Eigen::Vector3d& default_value) {
  known_.insert(key);
  return Has(key) ? GetVector3(key) : default_value;
}

Eigen::Quaterniond ParameterReader::GetRotation(const std::string& key,
                                                const Eigen::Quaterniond& default_value) {
  known_.insert(key);
  if (!Has(key)) return default_value;
  const YAML::Node value = std::as_const(node_)[key];
  if (!value.IsSequence() || (value.size() != 3 && value.size() != 4)) {
    Refuse(Name(key), value, "[x, y, z, w] or [roll, pitch, yaw]");
  }
  if (value.size() == 3) {
    const Eigen::Vector3d rpy = GetVector3(key);
    // About fixed axes, as in URDF.
    return Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
  }
  Eigen::Quaterniond q;
  for (std::size_t i = 0; i < 4; ++i) {
    q.coeffs()(static_cast<Eigen::Index>(i)) =
        ToDouble(value[i], Name(key) + "." + std::to_string(i));
  }
  if (std::abs(q.norm() - 1.0) > kUnitTolerance) {
    Refuse(Name(key), value, "a quaternion [x, y, z, w] of length 1 (to 0.001)");
  }
  return q.normalized();
}

void ParameterReader::CheckNoUnknownKeys() const {
  if (node_.IsNull()) return;
  for (const auto& entry : node_) {
    const std::string& key = entry.first.Scalar();
    if (known_.count(key) > 0) continue;
    std::string names;
    for (const std::string& name : known_) names += (names.empty() ? "" : ", ") + name;
    throw std::invalid_argument(Name(key) + " is not a known key; expected one of: " + names);
  }
}

}  // namespace vacuum_gripper_sim
