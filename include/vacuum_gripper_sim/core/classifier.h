#pragma once

#include <cstdint>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/edge_ways.h"

namespace vacuum_gripper_sim {

/// The five zones of [Bernardin, Sec. III-B], numbered as on `~surface_points`.
enum class Zone : std::uint8_t {
  kStrictlyOutside = 0,  ///< Yellow: open to the ambient.
  kOuterBorder = 1,      ///< Purple: the first contact points met from outside.
  kInActiveContact = 2,  ///< Red.
  kInnerBorder = 3,      ///< Blue: the first contact points met from inside.
  kStrictlyInside = 4,   ///< Green: open to the port only.
};
inline constexpr int kNumZones = 5;

/// What the classifier says of the cavity surface.
struct Classification {
  std::vector<double> bottleneck_gaps;  ///< g* of each cup: widest gap that leads from port to rim;
                                        ///< < 0: loaded ring. [m]
  std::vector<Zone> zones;              ///< A zone a point.
  std::vector<bool> wet;  ///< The points that the cavity's pressure acts on if it is sealed.
  std::vector<EdgeWay> edge_ways;  ///< Those that were given.
};

/** Decides where the cavity of each cup ends and how wide its widest way out is.

 [Bernardin, Algorithm 1] floods the surface from its border through the points that are not in
 contact; what remains is the cavity. Here the same flood runs from the border *and* from the port
 in order of decreasing opening phi (a watershed with two seeds):

     phi_i = gap_i >= 0 where point i carries no contact force,
     phi_i < 0 where it does, the lower the more it is loaded (any compliance makes it a length).

 The bottleneck g* is the largest value such that a path of points with phi >= g* joins port and
 border. A negative g* says that a loaded ring closes the cavity; the seal's tolerance is compared
 with g* by the caller, so it moves neither the cavity's area nor the zones' borders.

 Wet is what the port's flood owns, loaded or not (a contact that also carries suction gives the
 same shape and the same force on the mount), except trapped pockets: open points (phi > open_gap)
 that reach neither port nor border through open points. A pocket keeps the air that it closed over,
 that is `was_wet`.

 Zones are those of the paper, with "in contact" meaning phi <= open_gap. When port and border are
 joined by open points, no point is inside (Algorithm 1, line 28).

 A flood also takes the ways across edges that are open between closed ends, as wide as they are. */
class Classifier {
 public:
  /// @param surface The cavity surface, n points; must outlive this.
  explicit Classifier(const CavitySurface& surface) : surface_(&surface) {}

  /** @param phi      Opening of each point, n. [m]
      @param open_gap Points with phi above this count as open. [m]
      @param was_wet  The points that saw suction before this step, n; empty: none.
      @param[in,out] classification On entry its edge_ways are the ways across edges, wider than
        open_gap.
      @throws std::invalid_argument if the sizes disagree. */
  void Classify(const std::vector<double>& phi, double open_gap, const std::vector<bool>& was_wet,
                Classification* classification);

 private:
  enum class Basin : std::uint8_t { kNone, kPort, kBorder };
  /// A point that a flood may take next.
  struct Shore {
    double phi;  // of the point, or of a narrower way to it
    int order;   // first come, first served among equals: the outcome depends on the input alone
    int point;
    int parent;
    Basin basin;
    bool operator<(const Shore& other) const {
      return phi != other.phi ? phi < other.phi : order > other.order;
    }
  };

  void Flood(const std::vector<double>& phi, const std::vector<EdgeWay>& ways);
  void PushShore(const Shore& shore);
  double BottleneckGap(int cup, const std::vector<EdgeWay>& ways) const;
  void ReachThroughOpen(const std::vector<int>& seeds, const std::vector<EdgeWay>& ways,
                        std::vector<bool>* reached);

  const CavitySurface* surface_;
  // The two floods: which basin owns each point, the lowest phi on the way there from its seed, and
  // the points to take, a heap.
  std::vector<Basin> basin_;
  std::vector<double> bottleneck_;
  std::vector<Shore> shores_;
  std::vector<bool> reached_in_full_;  // by point: by a way that is no narrower than the point

  std::vector<bool> open_, outside_, inside_;  // by point
  std::vector<int> stack_;
};

/// Classifies once, see Classifier.
Classification Classify(const CavitySurface& surface, const std::vector<double>& phi,
                        double open_gap, const std::vector<bool>& was_wet = {},
                        std::vector<EdgeWay> edge_ways = {});

}  // namespace vacuum_gripper_sim
