#pragma once

#include <string>

namespace vacuum_gripper_sim {

/** The directory that holds the package's `config` and `meshes`: that of an installed package,
 found beside the running executable (`<prefix>/lib/vacuum_gripper_sim/x` or `<prefix>/bin/x`, below
 `<prefix>/share/vacuum_gripper_sim`), else the source directory that it was built from. No
 environment variable has a say in it.
 @throws std::runtime_error when neither holds them. */
std::string ShareDirectory();

/** The directory of any ROS package, as `package://` means it: of this one its ShareDirectory(); of
 another `share/<name>` below an entry of CMAKE_PREFIX_PATH (as an installed package is), or else a
 folder below an entry of ROS_PACKAGE_PATH whose package.xml has that name.
 @returns an empty string if there is none. */
std::string PackageDirectory(const std::string& name);

}  // namespace vacuum_gripper_sim
