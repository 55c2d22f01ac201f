#pragma once

#include <algorithm>
#include <cmath>

namespace vacuum_gripper_sim {

/** Root of a continuous function that never falls, by Chandrupatla's method [Chandrupatla 1997,
 Adv. Eng. Softw. 28(3)]: inverse quadratic interpolation where it is safe, bisection elsewhere.

 @param f Monotone. @param lower,upper Bracket it: f(lower) <= 0 <= f(upper).
 @param tolerance On the argument; what double precision resolves is enough in any case. */
template <typename Function>
double MonotoneRoot(const Function& f, double lower, double upper, double tolerance) {
  double a = upper, b = lower;  // b is the newest point, a the other end of the bracket
  double f_a = f(a), f_b = f(b);
  double c = a, f_c = f_a;  // the point before b
  double t = 0.5;
  for (int i = 0; i < 200; ++i) {
    if (f_a == 0.0) return a;
    if (f_b == 0.0) return b;
    const double x = a + t * (b - a);
    const double f_x = f(x);
    if ((f_x > 0.0) == (f_a > 0.0)) {
      c = a;
      f_c = f_a;
    } else {
      c = b;
      f_c = f_b;
      b = a;
      f_b = f_a;
    }
    a = x;
    f_a = f_x;
    const double best = std::abs(f_a) < std::abs(f_b) ? a : b;
    const double least = 2e-16 * std::abs(best) + 0.5 * tolerance;
    const double t_least = least / std::abs(b - a);
    if (t_least > 0.5 || f_a == 0.0) return best;

    const double xi = (a - b) / (c - b);
    const double phi = (f_a - f_b) / (f_c - f_b);
    t = 0.5;
    if (phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi) {
      t = f_a / (f_b - f_a) * f_c / (f_b - f_c) +
          (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b);
    }
    t = std::clamp(t, t_least, 1.0 - t_least);
  }
  return std::abs(f_a) < std::abs(f_b) ? a : b;
}

}  // namespace vacuum_gripper_sim
