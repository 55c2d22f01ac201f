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
inline Material ReferenceA20(MaterialModel model = MaterialModel::kCorotational) {
  return {338000.0, 0.45, 1080.0, model};
}
inline Material ReferenceA30() { return {593000.0, 0.45, 1080.0}; }

/// What a converged solution says: one value (of the neo-Hookean law for the neo-Hookean one), or
/// the spread between two materials that a linear co-rotational one is expected to lie in.
struct Reference {
  double a;
  double b;
  Reference(double value) : a(value), b(value) {}  // NOLINT: a value is a spread of none
  Reference(double first, double second) : a(first), b(second) {}

  /// Signed distance from the spread; 0 within it.
  double Distance(double value) const {
    return value - std::clamp(value, std::min(a, b), std::max(a, b));
  }
  /// Of the end of the spread that is nearest to the value.
  double Magnitude(double value) const {
    return std::abs(std::clamp(value, std::min(a, b), std::max(a, b)));
  }
  std::string Text() const {
    char text[64];
    std::snprintf(text, sizeof(text), a == b ? "%.6g" : "%.6g..%.6g", a, b);
    return text;
  }
};

/// Bounds of a case's error: what we hold ourselves to, and, where that is not reached, the error
/// found, which must not grow.
struct Tolerance {
  double target;
  double reached;
  Tolerance(double target_) : target(target_), reached(target_) {}  // NOLINT: the target is reached
  Tolerance(double target_, double reached_) : target(target_), reached(reached_) {}
};

/// Prints case, value, reference, error, tolerance and verdict; expects |error| <= reached.
/// @param error,tolerance In `unit`s times `scale`.
inline void Judge(const std::string& name, double value, const Reference& reference, double error,
                  const Tolerance& tolerance, double scale, const char* unit) {
  const char* verdict = std::abs(error) <= tolerance.target ? "PASS" : "FAIL";
  std::printf("%-46s %12.6g, reference %22s, error %+9.4f%s, tolerance %g%s, %s\n", name.c_str(),
              value, reference.Text().c_str(), scale * error, unit, scale * tolerance.target, unit,
              verdict);
  std::fflush(stdout);
  EXPECT_LE(std::abs(error), tolerance.reached) << name;
}

/// Judges the relative error.
inline void Compare(const std::string& name, double value, const Reference& reference,
                    const Tolerance& tolerance) {
  Judge(name, value, reference, reference.Distance(value) / reference.Magnitude(value), tolerance,
        100.0, " %");
}

/// Judges the error in the value's own unit.
inline void CompareAbsolute(const std::string& name, double value, const Reference& reference,
                            const Tolerance& tolerance) {
  Judge(name, value, reference, reference.Distance(value), tolerance, 1.0, "");
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

  /// Force on the mount [N] over its height [m] in the airtight rows at this pressure [Pa]: those
  /// with `sealed` and `seal_ok`, whose seal was found consistently. The first of equal heights.
  std::map<double, double> Forces(double pressure) const {
    std::map<double, double> forces;
    for (const Row& row : rows_) {
      if (row.at("p") == pressure && row.at("sealed") == 1.0 && row.at("seal_ok") == 1.0) {
        forces.emplace(1e-6 * std::round(1e6 * row.at("clamp_uz")), row.at("F_clamp"));
      }
    }
    return forces;
  }

  /// One of Forces().
  double Force(double clamp_uz, double pressure) const {
    for (const auto& [height, force] : Forces(pressure)) {
      if (std::abs(height - clamp_uz) < 1e-7) return force;
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
