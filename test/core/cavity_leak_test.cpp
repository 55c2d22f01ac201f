#include "vacuum_gripper_sim/core/cavity_leak.h"

#include <gtest/gtest.h>

#include "vacuum_gripper_sim/core/gas_flow.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kAmbient = air::kAmbientPressure;

TEST(CupLeak, IsTheSumOfLipWallAndHoles) {
  CupLeak leak;
  EXPECT_EQ(leak.Throughput(kAmbient, 9e4), 0.0);
  leak.hole_area = 2e-7;
  const double hole = OrificeThroughput(2e-7, kAmbient, 9e4);
  EXPECT_EQ(leak.Throughput(kAmbient, 9e4), hole);
  leak.porosity = 3e-10;
  const double wall = 3e-10 * 0.5 * (kAmbient * kAmbient - 9e4 * 9e4);
  EXPECT_NEAR(leak.Throughput(kAmbient, 9e4), hole + wall, 1e-12 * (hole + wall));
  leak.lip.sectors = {{1e-14, 1.0}, {2e-14, 1.0}};
  const double lip = SlitThroughput(3e-14, kAmbient, 9e4);
  EXPECT_NEAR(leak.Throughput(kAmbient, 9e4), hole + wall + lip, 1e-12 * (hole + wall + lip));
  EXPECT_EQ(leak.Throughput(9e4, kAmbient), -leak.Throughput(kAmbient, 9e4));
  EXPECT_EQ(leak.Throughput(9e4, 9e4), 0.0);
}

TEST(CupLeak, ItsEquivalentOrificeLetsThroughAsMuch) {
  CupLeak leak;
  leak.hole_area = 2e-7;
  EXPECT_NEAR(leak.EquivalentArea(kAmbient, 9e4), 2e-7, 1e-19);
  leak.porosity = 3e-10;
  const double area = leak.EquivalentArea(kAmbient, 4e4);
  EXPECT_NEAR(OrificeThroughput(area, kAmbient, 4e4), leak.Throughput(kAmbient, 4e4), 1e-12);
  EXPECT_EQ(leak.EquivalentArea(kAmbient, kAmbient), 0.0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
