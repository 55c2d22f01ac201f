// Queries of the quadratic cup's surface nodes while it is pulled, 60 steps over and over, against
// surfaces of 100 000 triangles; and of points against the cup's own faces. Each time is that of
// one sweep over all nodes, or of one step's queries: to be compared with a step's time.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "grip_situation.h"
#include "support/surface_meshes.h"
#include "vacuum_gripper_sim/core/cup_faces.h"
#include "vacuum_gripper_sim/core/surface_sighting.h"

namespace vacuum_gripper_sim {
namespace {

constexpr int kSteps = 60;
constexpr double kReach = 2e-3;  // about what a node moves in some steps [m]

/// Where the nodes are after each step of a pull; the plate is z = 0.
struct Recording {
  TetMesh mesh;
  std::vector<int> nodes;  // of the surface
  std::vector<Eigen::Matrix3Xd> x;
};

const Recording& Pull() {
  static const Recording recording = [] {
    GripSituation grip("quadratic_700", Situation::kPulled, LinearSolverMethod::kDirect);
    Recording recorded;
    recorded.mesh = grip.cycle().simulator().mesh();
    const auto& faces = recorded.mesh.boundary_faces;
    const std::set<int> nodes(faces.data(), faces.data() + faces.size());
    recorded.nodes.assign(nodes.begin(), nodes.end());
    for (int i = 0; i < kSteps; ++i) {
      grip.Step();
      recorded.x.push_back(grip.result().x_W);
    }
    return recorded;
  }();
  return recording;
}

Mesh Share(Triangles mesh, double lift) {
  mesh.vertices.row(2).array() += lift;
  return std::make_shared<TriangleMesh>("mesh", mesh.vertices, mesh.triangles);
}

Shape MakeShape(const std::string& name) {
  if (name == "plane") return Plane{};
  if (name == "sheet_100k") return Share(MakeSheet(224, 0.2), 0.0);
  if (name == "sheet_2") return Share(MakeSheet(1, 0.2), 0.0);
  if (name == "box_100k") return Share(MakeBoxMesh(91, {0.2, 0.2, 0.1}), -0.05);
  return Share(MakeSphereMesh(91, 0.1), -0.1);
}

/// What each node is asked.
enum class Query { kDistance, kLook, kLookWithinReach };

void Sweep(benchmark::State& state, const std::string& name, Query query) {
  const Recording& pull = Pull();
  const Shape shape = MakeShape(name);
  std::vector<SurfaceSighting> sightings(pull.nodes.size());
  std::size_t step = 0;
  double sum = 0.0;
  for (auto _ : state) {
    const Eigen::Matrix3Xd& x = pull.x[step];
    step = (step + 1) % pull.x.size();
    for (std::size_t i = 0; i < pull.nodes.size(); ++i) {
      const Eigen::Vector3d p = x.col(pull.nodes[i]);
      sum += query == Query::kDistance ? Distance(shape, p).distance
             : query == Query::kLook   ? sightings[i].Look(shape, p).distance
                                       : sightings[i].Look(shape, p, kReach).distance;
    }
  }
  benchmark::DoNotOptimize(sum);
  state.counters["nodes"] = static_cast<double>(pull.nodes.size());
}

void BuildMesh(benchmark::State& state) {
  const Triangles soup = Soup(MakeSphereMesh(91, 0.1));
  for (auto _ : state) {
    benchmark::DoNotOptimize(TriangleMesh("mesh", soup.vertices, soup.triangles));
  }
}

/// Update() and 2 000 points along a cube's edges, `clearance` below the cup.
void FacesOfCup(benchmark::State& state, double clearance) {
  const Recording& pull = Pull();
  CupFaces faces(pull.mesh);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 2000; ++i) points.emplace_back(0.05 * (i / 1000.0 - 1.0), 0.0, -clearance);
  std::size_t step = 0;
  int found = 0;
  for (auto _ : state) {
    faces.Update(pull.x[step]);
    step = (step + 1) % pull.x.size();
    for (const Eigen::Vector3d& p : points) found += faces.Nearest(p, 1e-3) ? 1 : 0;
  }
  state.counters["found"] = benchmark::Counter(found, benchmark::Counter::kAvgIterations);
  state.counters["faces"] = faces.num_faces();
}

void RegisterAll() {
  const auto add = [](const std::string& name, const auto& function) {
    benchmark::RegisterBenchmark(name.c_str(), function)->Unit(benchmark::kMicrosecond);
  };
  for (const char* const shape : {"plane", "sheet_2", "sheet_100k", "box_100k", "sphere_100k"}) {
    for (const auto& [name, query] : {std::pair{"distance", Query::kDistance},
                                      {"look", Query::kLook},
                                      {"look_within_reach", Query::kLookWithinReach}}) {
      add(std::string(shape) + "/" + name,
          [shape = std::string(shape), query = query](benchmark::State& state) {
            Sweep(state, shape, query);
          });
    }
  }
  add("build_100k", BuildMesh);
  add("cup_faces/far", [](benchmark::State& state) { FacesOfCup(state, 0.1); });
  add("cup_faces/below", [](benchmark::State& state) { FacesOfCup(state, 0.002); });
  add("cup_faces/touching", [](benchmark::State& state) { FacesOfCup(state, 0.0); });
}

}  // namespace
}  // namespace vacuum_gripper_sim

int main(int argc, char** argv) {
  vacuum_gripper_sim::RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
