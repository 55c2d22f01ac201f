#pragma once

#include <Eigen/Core>
#include <ostream>
#include <string>

namespace vacuum_gripper_sim {

/// Numbers in the C locale, with the digits of all our tables. @param header Its first line.
void BeginCsv(const std::string& header, std::ostream* stream);

/// Three cells, a comma before each.
void WriteVector(const Eigen::Vector3d& v, std::ostream* stream);

/// A text as a cell, quoted where RFC 4180 wants it.
std::string CsvCell(const std::string& text);

}  // namespace vacuum_gripper_sim
