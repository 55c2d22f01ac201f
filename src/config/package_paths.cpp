#include "vacuum_gripper_sim/config/package_paths.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

// The build passes the directory of its sources; an installed package does without.
#ifndef VACUUM_GRIPPER_SOURCE_DIR
#define VACUUM_GRIPPER_SOURCE_DIR ""
#endif

namespace vacuum_gripper_sim {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxDepth = 5;  // of folders between an entry of ROS_PACKAGE_PATH and a package

/// Entries of a list such as ROS_PACKAGE_PATH.
std::vector<fs::path> EntriesOf(const char* variable) {
  std::vector<fs::path> entries;
  const char* const value = std::getenv(variable);
  std::istringstream list(value == nullptr ? "" : value);
  for (std::string entry; std::getline(list, entry, ':');) {
    if (!entry.empty()) entries.emplace_back(entry);
  }
  return entries;
}

/// Is `directory` the package's?
bool IsPackage(const fs::path& directory, const std::string& name) {
  std::ifstream manifest(directory / "package.xml");
  const std::string text{std::istreambuf_iterator<char>(manifest), {}};
  std::smatch match;
  return std::regex_search(text, match, std::regex("<name>\\s*(\\S+?)\\s*</name>")) &&
         match[1] == name;
}

/// Looks for a package below a folder, the nearest first; none within another package.
fs::path FindPackage(const fs::path& folder, const std::string& name, int depth) {
  std::error_code error;
  if (IsPackage(folder, name)) return folder;
  if (depth == 0 || fs::exists(folder / "package.xml", error) ||
      fs::exists(folder / "CATKIN_IGNORE", error)) {
    return {};
  }
  if (IsPackage(folder / name, name)) return folder / name;
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_directory(error) && entry.path().filename().string().front() != '.') {
      folders.push_back(entry.path());
    }
  }
  std::sort(folders.begin(), folders.end());
  for (const fs::path& below : folders) {
    const fs::path found = FindPackage(below, name, depth - 1);
    if (!found.empty()) return found;
  }
  return {};
}

}  // namespace

std::string ShareDirectory() {
  std::error_code error;
  std::vector<fs::path> candidates;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path directory = executable.parent_path();
    candidates.push_back(directory / "../../share/vacuum_gripper_sim");
    candidates.push_back(directory / "../share/vacuum_gripper_sim");
  }
  candidates.emplace_back(VACUUM_GRIPPER_SOURCE_DIR);
  for (const fs::path& candidate : candidates) {
    // A catkin devel space has the share directory too, but nothing of ours in it.
    if (!candidate.empty() && fs::is_directory(candidate / "config" / "cups", error)) {
      return candidate.lexically_normal().string();
    }
  }
  throw std::runtime_error(
      "the package's config directory is missing; expected it in share/vacuum_gripper_sim beside "
      "the executable's prefix or in the source directory");
}

std::string PackageDirectory(const std::string& name) {
  if (name == "vacuum_gripper_sim") return ShareDirectory();
  for (const fs::path& prefix : EntriesOf("CMAKE_PREFIX_PATH")) {
    if (IsPackage(prefix / "share" / name, name)) return (prefix / "share" / name).string();
  }
  for (const fs::path& entry : EntriesOf("ROS_PACKAGE_PATH")) {
    const fs::path found = FindPackage(entry, name, kMaxDepth);
    if (!found.empty()) return found.string();
  }
  return {};
}

}  // namespace vacuum_gripper_sim
