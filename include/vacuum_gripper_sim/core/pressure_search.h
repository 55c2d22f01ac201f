#pragma once

#include <optional>

namespace vacuum_gripper_sim {

/** Finds the pressure p at which a cup, loaded with it, leaves its air at that very pressure: a
 root of r(p) = f(p) - p, where f takes a solve of the cup. Secant steps, the first along a slope
 remembered from an earlier search, kept within the bracket that the signs of r have shown so far (r
 falls where the root is stable). */
class PressureSearch {
 public:
  /// @param slope Guess of dr/dp, < 0; -1 where f hardly depends on p. [-]
  explicit PressureSearch(double slope = -1.0) : slope_(slope) {}

  /// @param p Tried. [Pa] @param f What the air made of it. [Pa] @returns what to try next. [Pa]
  double Next(double p, double f);

  /// dr/dp as known by now. [-]
  double slope() const { return slope_; }

 private:
  double slope_;
  std::optional<double> low_, high_;  // r is positive, negative there
  std::optional<double> last_p_, last_r_;
};

}  // namespace vacuum_gripper_sim
