#include "vacuum_gripper_sim/config/package_paths.h"

#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <vector>

// The build passes the directory of its sources; an installed package does without.
#ifndef VACUUM_GRIPPER_SOURCE_DIR
#define VACUUM_GRIPPER_SOURCE_DIR ""
#endif

namespace vacuum_gripper_sim {

std::string ShareDirectory() {
  namespace fs = std::filesystem;
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

}  // namespace vacuum_gripper_sim
