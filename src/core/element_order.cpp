#include "vacuum_gripper_sim/core/element_order.h"

#include <cstddef>

namespace vacuum_gripper_sim {
namespace {

/// Elements by their distance from one of them; pieces that are not connected with it at the end.
class Walk {
 public:
  Walk(const TetMesh& mesh, int start) : seen_(static_cast<std::size_t>(mesh.num_elements())) {
    std::vector<std::vector<int>> elements_of(static_cast<std::size_t>(mesh.num_nodes()));
    for (int e = 0; e < mesh.num_elements(); ++e) {
      for (Eigen::Index a = 0; a < mesh.elements.rows(); ++a) {
        elements_of[static_cast<std::size_t>(mesh.elements(a, e))].push_back(e);
      }
    }
    Visit(start);
    int next_start = 0;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      while (i == order_.size()) Visit(next_start++);
      const int reached = order_[i];
      for (Eigen::Index a = 0; a < mesh.elements.rows(); ++a) {
        for (const int e : elements_of[static_cast<std::size_t>(mesh.elements(a, reached))]) {
          Visit(e);
        }
      }
    }
  }
  const std::vector<int>& order() const { return order_; }

 private:
  void Visit(int e) {
    if (!seen_[static_cast<std::size_t>(e)]) order_.push_back(e);
    seen_[static_cast<std::size_t>(e)] = true;
  }

  std::vector<bool> seen_;
  std::vector<int> order_;
};

}  // namespace

std::vector<int> OrderByNeighbours(const TetMesh& mesh) {
  if (mesh.num_elements() == 0) return {};
  const int farthest = Walk(mesh, 0).order().back();
  return Walk(mesh, farthest).order();
}

}  // namespace vacuum_gripper_sim
