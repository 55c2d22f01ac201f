#include "vacuum_gripper_sim/core/vacuum_faults.h"

#include <cmath>
#include <string>

#include "require.h"

namespace vacuum_gripper_sim {

void Validate(const VacuumFaults& faults, std::size_t num_cups, std::size_t num_objects) {
  Require(faults.cups.size() <= num_cups, "faults.cups: number of entries",
          static_cast<double>(faults.cups.size()), "at most that of the cups");
  Require(faults.permeances.size() <= num_objects, "faults.permeances: number of entries",
          static_cast<double>(faults.permeances.size()), "at most that of the objects");
  for (std::size_t i = 0; i < faults.cups.size(); ++i) {
    const std::string cup = "faults.cups[" + std::to_string(i) + "].";
    const CupFaults& of_cup = faults.cups[i];
    Require(of_cup.hose_opening >= 0.0 && of_cup.hose_opening <= 1.0,
            (cup + "hose_opening").c_str(), of_cup.hose_opening, "in [0, 1] [-]");
    RequireNotNegative((cup + "torn_area").c_str(), of_cup.torn_area, "[m^2]");
    for (std::size_t k = 0; k < of_cup.dirt.size(); ++k) {
      const std::string dirt = cup + "dirt[" + std::to_string(k) + "].";
      Require(std::isfinite(of_cup.dirt[k].azimuth), (dirt + "azimuth").c_str(),
              of_cup.dirt[k].azimuth, "finite [rad]");
      Require(of_cup.dirt[k].width >= 0.0 && of_cup.dirt[k].width <= 2.0 * M_PI,
              (dirt + "width").c_str(), of_cup.dirt[k].width, "in [0, 2 pi] [rad]");
      RequireNotNegative((dirt + "gap").c_str(), of_cup.dirt[k].gap, "[m]");
    }
  }
  for (std::size_t i = 0; i < faults.permeances.size(); ++i) {
    RequireNotNegative(("faults.permeances[" + std::to_string(i) + "]").c_str(),
                       faults.permeances[i], "[m/(Pa s)]");
  }
}

}  // namespace vacuum_gripper_sim
