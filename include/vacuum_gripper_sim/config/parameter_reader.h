#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <set>
#include <string>
#include <vector>

namespace vacuum_gripper_sim {

/** Typed, strict access to a YAML map.

 Every getter throws std::invalid_argument with one line that names the parameter by its dotted
 path, its value and what is allowed, and tells "not set" from "wrong type" (YAML 1.1 readers such
 as rosparam turn 593.0e3 into a string). Getters with a default leave the default where the key is
 absent. CheckNoUnknownKeys() refuses keys that no getter asked for: a typo is not a silent default.

 No ROS in here: the node turns its parameters into a YAML::Node first. */
class ParameterReader {
 public:
  /// @param node A map, or a null node (an empty map). @param path Prefix of the names in messages.
  explicit ParameterReader(const YAML::Node& node, std::string path = "");

  bool Has(const std::string& key) const;
  const std::string& path() const { return path_; }
  /// Dotted name of a key, for messages.
  std::string Name(const std::string& key) const;

  double GetDouble(const std::string& key);  ///< Finite.
  double GetDouble(const std::string& key, double default_value);
  int GetInt(const std::string& key);
  int GetInt(const std::string& key, int default_value);
  bool GetBool(const std::string& key, bool default_value);
  std::string GetString(const std::string& key);
  std::string GetString(const std::string& key, const std::string& default_value);
  /// One of `allowed`.
  std::string GetChoice(const std::string& key, const std::vector<std::string>& allowed,
                        const std::string& default_value);
  Eigen::Vector3d GetVector3(const std::string& key);
  Eigen::Vector3d GetVector3(const std::string& key, const Eigen::Vector3d& default_value);
  /// Rotation as `[x, y, z, w]` (unit quaternion) or `[roll, pitch, yaw]` [rad].
  Eigen::Quaterniond GetRotation(const std::string& key, const Eigen::Quaterniond& default_value);

  /// Reader of the map below `key`; an absent key gives an empty one.
  ParameterReader GetMap(const std::string& key);
  /// The raw node below `key`, for sequences and unions; null if absent.
  YAML::Node GetNode(const std::string& key);

  /// @throws std::invalid_argument naming the first key that no getter asked for, and those known.
  void CheckNoUnknownKeys() const;

 private:
  YAML::Node node_;
  std::string path_;
  std::set<std::string> known_;
};

}  // namespace vacuum_gripper_sim
