// Disc of radius 20 mm and 2 mm thickness of A20, its rim clamped, follower pressure from below.
#include <gtest/gtest.h>

#include <algorithm>

#include "validation/reference_case.h"
#include "validation/statics.h"

namespace vacuum_gripper_sim {
namespace {

class Disc {
 public:
  explicit Disc(const std::string& name, MaterialModel model = MaterialModel::kCorotational)
      : mesh_(LoadReferenceMesh(name)),
        bottom_(MakeCavitySurface(mesh_)),
        material_(ReferenceA20(model)) {}

  /// Largest rise of the bottom's nodes [m]; checks the support on the way.
  double Rise(double pressure, int increments) const {
    Statics statics(mesh_, material_, mesh_.mount_nodes);
    statics.SetPressure(bottom_, pressure);
    const Statics::Solution solution = statics.Solve(increments);
    char name[64];
    std::snprintf(name, sizeof(name), "%s%s, %g Pa: support [N]",
                  mesh_.quadratic() ? "disc quadratic" : "disc linear",
                  material_.model == MaterialModel::kNeoHookean ? " nh" : "", pressure);
    Compare(name, solution.support.z(), -pressure * BottomArea(), 1e-5);
    double rise = 0.0;
    for (const int node : bottom_.nodes) {
      rise = std::max(rise, solution.x(2, node) - mesh_.nodes(2, node));
    }
    return rise;
  }

  /// Of the polygon through the rim's nodes, which is clamped. [m^2]
  double BottomArea() const {
    std::vector<std::pair<double, Eigen::Vector2d>> rim;
    for (const int point : bottom_.border) {
      const Eigen::Vector2d p =
          mesh_.nodes.col(bottom_.nodes[static_cast<std::size_t>(point)]).head<2>();
      rim.emplace_back(std::atan2(p.y(), p.x()), p);
    }
    std::sort(rim.begin(), rim.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    double area = 0.0;
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const Eigen::Vector2d& p = rim[i].second;
      const Eigen::Vector2d& q = rim[(i + 1) % rim.size()].second;
      area += 0.5 * (p.x() * q.y() - p.y() * q.x());
    }
    return area;
  }

 private:
  TetMesh mesh_;
  CavitySurface bottom_;
  Material material_;
};

TEST(Disc, LinearElementsAgainstTheSameMesh) {
  const Disc disc("disc_linear");
  Compare("disc linear: area of the bottom [m^2]", disc.BottomArea(), 0.06272774335536449 / 50.0,
          1e-9);
  Compare("disc linear, 50 Pa: max w [m]", disc.Rise(50.0, 1), {9.167788e-5, 9.167972e-5}, 0.03);
  Compare("disc linear, 1 kPa: max w [m]", disc.Rise(1000.0, 3), {1.712948e-3, 1.759834e-3}, 0.03);
  Compare("disc linear, 4 kPa: max w [m]", disc.Rise(4000.0, 6), {4.76513e-3, 5.39313e-3}, 0.03);
}

TEST(Disc, QuadraticElementsAgainstTheSameMesh) {
  const Disc disc("disc_quadratic");
  Compare("disc quadratic, 50 Pa: max w [m]", disc.Rise(50.0, 1), {4.082851e-4, 4.092309e-4}, 0.03);
  Compare("disc quadratic, 1 kPa: max w [m]", disc.Rise(1000.0, 3), {3.295259e-3, 3.449931e-3},
          0.03);
}

TEST(Disc, NeoHookeanAgainstNeoHookean) {
  const Disc linear("disc_linear", MaterialModel::kNeoHookean);
  Compare("disc linear nh, 1 kPa: max w [m]", linear.Rise(1000.0, 3), 1.759834e-3, 0.03);
  Compare("disc linear nh, 4 kPa: max w [m]", linear.Rise(4000.0, 6), 5.39313e-3, 0.03);

  const Disc quadratic("disc_quadratic", MaterialModel::kNeoHookean);
  const double small = quadratic.Rise(1000.0, 3);
  const double large = quadratic.Rise(4000.0, 6);
  Compare("disc quadratic nh, 1 kPa: max w [m]", small, 3.54893e-3, 0.05);
  Compare("disc quadratic nh, 4 kPa: max w [m]", large, 6.542136e-3, 0.05);
  Compare("disc quadratic nh, same mesh, 1 kPa: max w [m]", small, 3.449931e-3, 0.03);
  Compare("disc quadratic nh, same mesh, 4 kPa: max w [m]", large, 6.422686e-3, 0.03);
}

}  // namespace
}  // namespace vacuum_gripper_sim
