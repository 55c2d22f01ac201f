#pragma once

#include <string>

namespace vacuum_gripper_sim {

/** The directory that holds the package's `config` and `meshes`: that of an installed package,
 found beside the running executable (`<prefix>/lib/vacuum_gripper_sim/x` or `<prefix>/bin/x`, below
 `<prefix>/share/vacuum_gripper_sim`), else the source directory that it was built from. No
 environment variable has a say in it.
 @throws std::runtime_error when neither holds them. */
std::string ShareDirectory();

}  // namespace vacuum_gripper_sim
