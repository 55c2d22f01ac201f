#include "vacuum_gripper_sim/core/lip_leak.h"

#include <gtest/gtest.h>

#include <vector>

#include "counter.h"
#include "physics/grip_cycle.h"

namespace vacuum_gripper_sim {
namespace {

TEST(LipLeak, MeasuresWithoutAllocatingAfterTheFirstTime) {
  const TetMesh mesh = LoadBell("linear_700");
  const CavitySurface surface = MakeCavitySurface(mesh);
  LipLeak leak(surface, mesh.nodes, 424e3);
  LipContact contact;
  for (const int node : surface.nodes) {
    contact.gap.push_back(mesh.nodes(2, node));
    contact.normal_force.push_back(0.1);
    contact.roughness.push_back(1e-5);
  }
  const std::vector<DirtSector> dirt{{0.5, 0.3, 1e-4}};
  LeakPaths paths;
  leak.Measure(mesh.nodes, contact, dirt, &paths);

  const long before = CountAllocations();
  leak.Measure(mesh.nodes, contact, dirt, &paths);
  const double throughput = paths.Throughput(1e5, 9e4);
  EXPECT_EQ(CountAllocations() - before, 0);
  EXPECT_GT(throughput, 0.0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
