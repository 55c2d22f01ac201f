#include "vacuum_gripper_sim/core/classifier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "vacuum_gripper_sim/core/cavity_size.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kOpenGap = 1e-4;  // m
constexpr double kFar = 5e-3;      // an open point [m]
constexpr double kLoaded = -1e-5;  // a loaded point [m]
constexpr int kSectors = 12;
constexpr int kRings = 6;

/** A disc of rings as seen from below: point 0 is the port, ring r = 1 .. kRings has kSectors
 points, the outermost ring is the border. Every cell is cut by one diagonal. */
CavitySurface MakeDisc() {
  CavitySurface surface;
  surface.nodes.resize(1 + kRings * kSectors);
  std::vector<std::set<int>> sets(surface.nodes.size());
  const auto at = [](int ring, int sector) {
    return ring == 0 ? 0 : 1 + (ring - 1) * kSectors + (sector + kSectors) % kSectors;
  };
  const auto join = [&](int a, int b) {
    sets[static_cast<std::size_t>(a)].insert(b);
    sets[static_cast<std::size_t>(b)].insert(a);
  };
  for (int ring = 1; ring <= kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      join(at(ring, sector), at(ring, sector + 1));
      join(at(ring, sector), at(ring - 1, sector));
      if (ring > 1) join(at(ring, sector), at(ring - 1, sector + 1));
    }
  }
  for (const auto& set : sets) surface.neighbours.emplace_back(set.begin(), set.end());
  surface.port = {0};
  for (int sector = 0; sector < kSectors; ++sector) surface.border.push_back(at(kRings, sector));
  surface.first_points = {0, surface.num_points()};
  return surface;
}

/// phi of the disc: `value` on the points of one ring.
void SetRing(std::vector<double>* phi, int ring, double value) {
  const auto begin = phi->begin() + 1 + (ring - 1) * kSectors;
  std::fill(begin, begin + kSectors, value);
}

int Point(int ring, int sector) { return 1 + (ring - 1) * kSectors + sector; }

class ClassifierTest : public testing::Test {
 protected:
  const CavitySurface surface_ = MakeDisc();
  std::vector<double> phi_ = std::vector<double>(surface_.nodes.size(), kFar);

  Zone ZoneAt(const Classification& result, int ring, int sector) const {
    return result.zones[static_cast<std::size_t>(Point(ring, sector))];
  }
  long NumWet(const Classification& result) const {
    return std::count(result.wet.begin(), result.wet.end(), true);
  }
};

TEST_F(ClassifierTest, InTheAirAllIsOutside) {
  const Classification result = Classify(surface_, phi_, kOpenGap);
  EXPECT_EQ(result.bottleneck_gaps[0], kFar);
  EXPECT_EQ(CountZones(surface_, 0, result.zones)[0], surface_.nodes.size());
}

// One ring of contact points: purple from outside; nothing is left to be blue, the paper's order.
TEST_F(ClassifierTest, ClosedRingSeparatesInsideFromOutside) {
  SetRing(&phi_, 4, kLoaded);
  const Classification result = Classify(surface_, phi_, kOpenGap);
  EXPECT_EQ(result.bottleneck_gaps[0], kLoaded);
  EXPECT_EQ(ZoneAt(result, 5, 0), Zone::kStrictlyOutside);
  EXPECT_EQ(ZoneAt(result, 4, 0), Zone::kOuterBorder);
  EXPECT_EQ(ZoneAt(result, 3, 0), Zone::kStrictlyInside);
  EXPECT_EQ(result.zones[0], Zone::kStrictlyInside);
  const std::array<std::uint32_t, kNumZones> counts{2 * kSectors, kSectors, 0, 0, 1 + 3 * kSectors};
  EXPECT_EQ(CountZones(surface_, 0, result.zones), counts);
}

// Three rings wide: purple, red and blue, one ring each; the watershed runs along the most loaded.
TEST_F(ClassifierTest, WideRingHasBordersOnBothSides) {
  SetRing(&phi_, 3, kLoaded);
  SetRing(&phi_, 4, 5.0 * kLoaded);
  SetRing(&phi_, 5, kLoaded);
  const Classification result = Classify(surface_, phi_, kOpenGap);
  EXPECT_EQ(ZoneAt(result, 5, 2), Zone::kOuterBorder);
  EXPECT_EQ(ZoneAt(result, 4, 2), Zone::kInActiveContact);
  EXPECT_EQ(ZoneAt(result, 3, 2), Zone::kInnerBorder);
  EXPECT_DOUBLE_EQ(result.bottleneck_gaps[0], 5.0 * kLoaded);
  EXPECT_TRUE(result.wet[static_cast<std::size_t>(Point(3, 2))]);
  EXPECT_FALSE(result.wet[static_cast<std::size_t>(Point(5, 2))]);
}

// A gap of one point leads out: its width is the bottleneck, and all is outside.
TEST_F(ClassifierTest, RingWithAGapOfOnePointLeaks) {
  SetRing(&phi_, 4, kLoaded);
  const double gap = 3e-4;
  phi_[static_cast<std::size_t>(Point(4, 7))] = gap;
  const Classification result = Classify(surface_, phi_, kOpenGap);
  EXPECT_EQ(result.bottleneck_gaps[0], gap);
  EXPECT_EQ(CountZones(surface_, 0, result.zones)[static_cast<std::size_t>(Zone::kStrictlyInside)],
            0U);
  EXPECT_EQ(result.zones[0], Zone::kStrictlyOutside);
  EXPECT_EQ(ZoneAt(result, 4, 0), Zone::kOuterBorder);
}

// A hole under an edge of the ring: its ends are loaded, and the way across it leads out all the
// same.
TEST_F(ClassifierTest, RingWithAHoleBetweenItsPointsLeaks) {
  SetRing(&phi_, 4, kLoaded);
  const double gap = 3e-4;
  const EdgeWay way{Point(4, 7), Point(4, 8), Point(3, 8), Point(5, 7), gap};
  const Classification result = Classify(surface_, phi_, kOpenGap, {}, {way});
  EXPECT_EQ(result.bottleneck_gaps[0], gap);
  EXPECT_EQ(CountZones(surface_, 0, result.zones)[static_cast<std::size_t>(Zone::kStrictlyInside)],
            0U);
  EXPECT_EQ(result.zones[0], Zone::kStrictlyOutside);
  ASSERT_EQ(result.edge_ways.size(), 1U);
  EXPECT_EQ(Classify(surface_, phi_, kOpenGap).bottleneck_gaps[0], kLoaded);
}

// The same gap below the tolerance: the zones show a seal, and the bottleneck says how wide it is.
TEST_F(ClassifierTest, GapBelowTheToleranceSeals) {
  SetRing(&phi_, 4, kLoaded);
  phi_[static_cast<std::size_t>(Point(4, 7))] = 0.5 * kOpenGap;
  const Classification result = Classify(surface_, phi_, kOpenGap);
  EXPECT_EQ(result.bottleneck_gaps[0], 0.5 * kOpenGap);
  EXPECT_EQ(result.zones[0], Zone::kStrictlyInside);
  EXPECT_TRUE(result.wet[0]);
}

// The border ring itself may be what touches; a rim wholly off the surface is the air.
TEST_F(ClassifierTest, RimInContactSeals) {
  SetRing(&phi_, kRings, kLoaded);
  const Classification result = Classify(surface_, phi_, kOpenGap);
  EXPECT_EQ(result.bottleneck_gaps[0], kLoaded);
  EXPECT_EQ(CountZones(surface_, 0, result.zones)[static_cast<std::size_t>(Zone::kStrictlyOutside)],
            0U);
  EXPECT_EQ(result.zones[0], Zone::kStrictlyInside);
  EXPECT_EQ(ZoneAt(result, kRings, 3), Zone::kInnerBorder);
}

// Pressed flat, Algorithm 1 finds no cavity and says "not airtight"; no air passes, though.
TEST_F(ClassifierTest, FullyCollapsedCupIsAirtight) {
  std::fill(phi_.begin(), phi_.end(), kLoaded);
  const Classification result = Classify(surface_, phi_, kOpenGap);
  EXPECT_LT(result.bottleneck_gaps[0], 0.0);
  EXPECT_EQ(CountZones(surface_, 0, result.zones)[static_cast<std::size_t>(Zone::kInActiveContact)],
            surface_.nodes.size());
}

// Two rings with air between them: that pocket sees neither port nor ambient. It keeps what it had.
TEST_F(ClassifierTest, TrappedPocketKeepsItsAir) {
  SetRing(&phi_, 3, kLoaded);
  SetRing(&phi_, 5, 2.0 * kLoaded);
  const Classification vented = Classify(surface_, phi_, kOpenGap);
  EXPECT_EQ(ZoneAt(vented, 4, 0), Zone::kInActiveContact);
  EXPECT_FALSE(vented.wet[static_cast<std::size_t>(Point(4, 0))]);
  EXPECT_TRUE(vented.wet[static_cast<std::size_t>(Point(2, 0))]);
  EXPECT_DOUBLE_EQ(vented.bottleneck_gaps[0], 2.0 * kLoaded);

  const std::vector<bool> was_wet(surface_.nodes.size(), true);
  EXPECT_TRUE(
      Classify(surface_, phi_, kOpenGap, was_wet).wet[static_cast<std::size_t>(Point(4, 0))]);
}

// With the port pressed shut, the ring of air around it is a pocket too.
TEST_F(ClassifierTest, PortInContactClosesTheCavity) {
  phi_[0] = kLoaded;
  SetRing(&phi_, 5, kLoaded);
  const Classification result = Classify(surface_, phi_, kOpenGap);
  EXPECT_LT(result.bottleneck_gaps[0], 0.0);
  EXPECT_FALSE(result.wet[static_cast<std::size_t>(Point(2, 0))]);
}

// Of two ways out the wider one counts, and a way is as wide as its narrowest point: 0.3 mm here.
TEST_F(ClassifierTest, BottleneckIsTheWidestOfTheNarrowest) {
  SetRing(&phi_, 3, kLoaded);
  SetRing(&phi_, 5, kLoaded);
  phi_[static_cast<std::size_t>(Point(3, 1))] = 9e-4;
  phi_[static_cast<std::size_t>(Point(5, 4))] = 3e-4;
  phi_[static_cast<std::size_t>(Point(5, 9))] = 2e-4;
  EXPECT_EQ(Classify(surface_, phi_, kOpenGap).bottleneck_gaps[0], 3e-4);
}

// Against brute force: the largest level above which port and border are joined.
TEST_F(ClassifierTest, BottleneckAgreesWithBruteForce) {
  unsigned state = 1;
  const auto random = [&] {  // [0, 1)
    state = 1664525U * state + 1013904223U;
    return static_cast<double>(state >> 8) / (1U << 24);
  };
  const auto random_point = [&] {
    return static_cast<int>(random() * static_cast<double>(phi_.size()));
  };
  for (int repeat = 0; repeat < 400; ++repeat) {
    for (double& value : phi_) value = (random() - 0.5) * 1e-3;
    std::vector<EdgeWay> ways(repeat < 200 ? 0 : 8);
    for (EdgeWay& way : ways) {
      way.from = random_point();
      way.to = random_point();
      way.gap = (random() - 0.5) * 1e-3;
    }
    const auto joined_above = [&](double level) {
      std::vector<int> stack = surface_.port;
      std::vector<bool> seen(phi_.size(), false);
      while (!stack.empty()) {
        const auto i = static_cast<std::size_t>(stack.back());
        const int point = stack.back();
        stack.pop_back();
        if (seen[i] || phi_[i] < level) continue;
        seen[i] = true;
        if (std::binary_search(surface_.border.begin(), surface_.border.end(), point)) return true;
        stack.insert(stack.end(), surface_.neighbours[i].begin(), surface_.neighbours[i].end());
        for (const EdgeWay& way : ways) {
          if (way.gap < level) continue;
          if (way.from == point) stack.push_back(way.to);
          if (way.to == point) stack.push_back(way.from);
        }
      }
      return false;
    };
    std::vector<double> levels = phi_;
    for (const EdgeWay& way : ways) levels.push_back(way.gap);
    std::sort(levels.rbegin(), levels.rend());
    const double expected = *std::find_if(levels.begin(), levels.end(), joined_above);
    EXPECT_EQ(Classify(surface_, phi_, kOpenGap, {}, ways).bottleneck_gaps[0], expected);
  }
}

TEST_F(ClassifierTest, RejectsSizeMismatch) {
  phi_.pop_back();
  EXPECT_THROW(Classify(surface_, phi_, kOpenGap), std::invalid_argument);
}

}  // namespace
}  // namespace vacuum_gripper_sim
