#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "vacuum_gripper_sim/core/gmsh_reader.h"
#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

inline std::string ReferencePath(const std::string& file) {
  return std::string(VACUUM_GRIPPER_SOURCE_DIR) + "/test/data/reference/" + file;
}

inline TetMesh LoadReferenceMesh(const std::string& name) {
  return ReadGmsh(ReferencePath(name + ".msh"));
}

/// Silicone of the references. [Pa], [-], [kg/m^3]
inline Material ReferenceA20() { return {338000.0, 0.45, 1080.0}; }
inline Material ReferenceA30() { return {593000.0, 0.45, 1080.0}; }

/// What a converged solution says: one value, or the spread between two materials that a linear
/// co-rotational one is expected to lie in.
struct Reference {
  double a;
  double b;
  Reference(double value) : a(value), b(value) {}  // NOLINT: a value is a spread of none
  Reference(double first, double second) : a(first), b(second) {}

  /// Signed distance from the spread, relative to its nearer end; 0 within it.
  double Error(double value) const {
    const double low = std::min(a, b);
    const double high = std::max(a, b);
    if (value < low) return (value - low) / std::abs(low);
    if (value > high) return (value - high) / std::abs(high);
    return 0.0;
  }
  std::string Text() const {
    char text[64];
    std::snprintf(text, sizeof(text), a == b ? "%.6g" : "%.6g..%.6g", a, b);
    return text;
  }
};

/// Bounds of a case, relative: what we hold ourselves to, and, where that is not reached, the error
/// found, which must not grow.
struct Tolerance {
  double target;
  double reached;
  Tolerance(double target_) : target(target_), reached(target_) {}  // NOLINT: the target is reached
  Tolerance(double target_, double reached_) : target(target_), reached(reached_) {}
};

inline void PrintVerdict(const std::string& name, double value, const std::string& reference,
                         double error_percent, double tolerance_percent) {
  std::printf("%-44s %12.6g %24s %+9.4f %% %8.3g %%  %s\n", name.c_str(), value, reference.c_str(),
              error_percent, tolerance_percent,
              std::abs(error_percent) <= tolerance_percent ? "PASS" : "FAIL");
  std::fflush(stdout);
}

/// Prints value, reference, error and tolerance, and expects the error below tolerance.reached.
inline void Compare(const std::string& name, double value, const Reference& reference,
                    const Tolerance& tolerance) {
  const double error = reference.Error(value);
  PrintVerdict(name, value, reference.Text(), 100.0 * error, 100.0 * tolerance.target);
  EXPECT_LE(std::abs(error), tolerance.reached)
      << name << ": " << value << ", reference " << reference.Text();
}

/// The same for a quantity with an absolute tolerance, printed as percent of that tolerance's unit.
inline void CompareAbsolute(const std::string& name, double value, const Reference& reference,
                            double target, double reached) {
  const double low = std::min(reference.a, reference.b);
  const double high = std::max(reference.a, reference.b);
  const double error = value < low ? value - low : value > high ? value - high : 0.0;
  std::printf("%-44s %12.6g %24s %+11.5f %10.3g  %s\n", name.c_str(), value,
              reference.Text().c_str(), error, target, std::abs(error) <= target ? "PASS" : "FAIL");
  std::fflush(stdout);
  EXPECT_LE(std::abs(error), reached) << name;
}

/// A CSV file with one line of column names; an empty field is NaN.
class ReferenceTable {
 public:
  explicit ReferenceTable(const std::string& file) : file_(file) {
    std::ifstream stream(ReferencePath(file));
    std::string line;
    if (!std::getline(stream, line)) throw std::runtime_error(file + " cannot be read");
    const std::vector<std::string> names = Split(line);
    while (std::getline(stream, line)) {
      const std::vector<std::string> fields = Split(line);
      rows_.emplace_back();
      for (std::size_t i = 0; i < names.size(); ++i) {
        const bool empty = i >= fields.size() || fields[i].empty();
        rows_.back()[names[i]] = empty ? std::nan("") : std::stod(fields[i]);
      }
    }
  }

  using Row = std::map<std::string, double>;
  const std::vector<Row>& rows() const { return rows_; }

  /// Force on the mount of the first airtight row at this mount height [m] and pressure [Pa]; the
  /// rows with `sealed` and `seal_ok` are those whose seal was found consistently. [N]
  double Force(double clamp_uz, double pressure) const {
    for (const Row& row : rows_) {
      if (std::abs(row.at("clamp_uz") - clamp_uz) < 1e-7 && row.at("p") == pressure &&
          row.at("sealed") == 1.0 && row.at("seal_ok") == 1.0) {
        return row.at("F_clamp");
      }
    }
    std::ostringstream message;
    message << file_ << " has no airtight row at clamp_uz = " << clamp_uz << ", p = " << pressure;
    throw std::runtime_error(message.str());
  }

 private:
  static std::vector<std::string> Split(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
  }

  std::string file_;
  std::vector<Row> rows_;
};

}  // namespace vacuum_gripper_sim
