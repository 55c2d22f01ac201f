#include "yardstick.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "thread_clock.h"

namespace vacuum_gripper_sim {

double Yardstick() {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(512, 512);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(512, 512);
  Eigen::MatrixXd c(512, 512);
  std::array<double, 15> times{};
  for (double& time : times) {
    const double begin = ThreadTime();
    c.noalias() = a * b;
    [[maybe_unused]] const volatile double needed = c(0, 0);  // or nothing would be computed
    time = ThreadTime() - begin;
  }
  auto* const median = times.begin() + times.size() / 2;
  std::nth_element(times.begin(), median, times.end());
  return *median;
}

}  // namespace vacuum_gripper_sim
