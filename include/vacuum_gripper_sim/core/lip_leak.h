#pragma once

#include <Eigen/Core>
#include <vector>

#include "vacuum_gripper_sim/core/cavity_surface.h"
#include "vacuum_gripper_sim/core/lip_meridians.h"

namespace vacuum_gripper_sim {

/// What the cavity's points touch, or miss; one value a point in each vector.
struct LipContact {
  std::vector<double> gap;           ///< Signed distance to the nearest surface; +inf: none. [m]
  std::vector<double> normal_force;  ///< Of the contacts, >= 0. [N]
  std::vector<double> roughness;     ///< h_rms of the nearest surface, >= 0. [m]
  double tolerance{0.0};  ///< Up to this a gap counts as touching: the seal's open_gap. [m]
};

/// Dirt that props the lip open.
struct DirtSector {
  double azimuth{0.0};  ///< Of its middle, about the mount's z axis from its x axis. [rad]
  double width{0.0};    ///< Angle about the axis, 0 to 2 pi. [rad]
  double gap{0.0};      ///< That it adds under the lip. [m]
};

/// How air gets under the lip in one sector.
struct LeakPath {
  double shape{0.0};  ///< Of SlitThroughput(). [m^3]
  double area{0.0};   ///< Of the narrowest section across the flow. [m^2]
};

/// The leak of a lip: one path a sector.
struct LeakPaths {
  std::vector<LeakPath> sectors;  ///< In the order of LipMeridians.

  /** Each sector lets through what a slit of its shape would, but no more than an orifice of its
   narrowest section. Antisymmetric, rising with p_from.
   @param p_from,p_to Absolute. [Pa] >= 0 @returns throughput. [Pa m^3/s] */
  double Throughput(double p_from, double p_to) const;
  /// Sum of the narrowest sections. [m^2]
  double area() const;
  /// Of the orifice that would let through as much between these pressures. [m^2]
  double EquivalentArea(double p_from, double p_to) const;
};

/** Measures how much a suction cup's lip leaks.

 Air passes under the lip along its meridians. Where a sector of width w(s) has the gap g(s) at s of
 its meridian, its slit has the shape

     1 / integral of ds / (w g^3),      g = g_rough(p) + max(0, gap - tolerance) + dirt,

 w and s being those of the deformed cup. Gaps run linearly between the crossings with the surface's
 edges; the integral over each piece is in closed form. Gaps wider than half the border's radius
 count as that, which makes the section under a lifted cup as large as its mouth.

 g_rough is HydraulicGap() under the nominal pressure p with which the sector touches: its force
 over the area of its meridian's part with gap <= tolerance. Nodal forces are no measure of the
 pressure next to them (corners of quadratic faces carry nothing under a uniform one), so they are
 first spread over the azimuth with a hat function as wide as four edges of the border. */
class LipLeak {
 public:
  /** @param rest Rest positions of all mesh nodes, 3 by #nodes; the cup's axis is z. [m]
      @param reduced_modulus E* = E / (1 - nu^2) of the cup. [Pa]
      @throws std::invalid_argument, see MakeLipMeridians(). */
  LipLeak(const CavitySurface& surface, const Eigen::Matrix3Xd& rest, double reduced_modulus);

  /** @param x_W Positions of all mesh nodes, 3 by #nodes. [m]
      @param dirt Where several cover the same sector, the highest counts.
      @param[out] paths
      @throws std::invalid_argument unless `contact` has one value a point. */
  void Measure(const Eigen::Matrix3Xd& x_W, const LipContact& contact,
               const std::vector<DirtSector>& dirt, LeakPaths* paths);

  const LipMeridians& meridians() const { return meridians_; }

 private:
  /// The lip at a crossing.
  struct Station {
    double gap{0.0};        // beyond the tolerance; negative: touching [m]
    double roughness{0.0};  // m
    double width{0.0};      // of the sector [m]
    double length{0.0};     // to the next station [m]
  };
  /// Where a point's force goes: to bin and, with `fraction`, to the one after it.
  struct Bin {
    int bin{0};
    double fraction{0.0};
  };
  /// What dirt covers of a sector.
  struct Cover {
    double part{0.0};  // 0 to 1
    double gap{0.0};   // m
  };

  void FindSmallestTouch(const Eigen::Matrix3Xd& rest);
  void PrepareSpread(const CavitySurface& surface, const Eigen::Matrix3Xd& rest);
  void PlaceStations(const Eigen::Matrix3Xd& x_W, const LipContact& contact);
  void SpreadForces(const std::vector<double>& normal_force);
  double ContactPressure(int meridian) const;
  LeakPath Path(int meridian, double rough_gap, double dirt_gap) const;
  static Cover CoverOf(int meridian, const std::vector<DirtSector>& dirt);

  LipMeridians meridians_;
  std::vector<int> nodes_;  // of the points
  double reduced_modulus_;
  double widest_gap_;           // m
  double smallest_touch_{0.0};  // area of a sector's touching part, at least [m^2]
  std::vector<Bin> bins_;       // of the points' azimuths
  std::vector<double> hat_;     // weights to one side, the middle first; all sum up to 1

  // Of the current call.
  Eigen::Matrix3Xd positions_W_;        // of the crossings [m]
  std::vector<Station> stations_;       // by crossing
  std::vector<double> binned_, force_;  // by sector [N]
};

}  // namespace vacuum_gripper_sim
