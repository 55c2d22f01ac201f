#include "vacuum_gripper_sim/core/step_matrix.h"

#include <algorithm>
#include <map>
#include <utility>

namespace vacuum_gripper_sim {

StepMatrix::StepMatrix(const ElasticBody& body, const std::vector<int>& free_row) : body_(&body) {
  std::map<std::pair<int, int>, int> place_of;  // by row and column, row >= column
  const auto find_place = [&](int row, int column) {
    const auto [place, is_new] =
        place_of.emplace(std::pair(row, column), static_cast<int>(pattern_.places.size()));
    if (is_new) pattern_.places.push_back({row, column});
    return place->second;
  };
  for (int node = 0; node < body.num_nodes(); ++node) {
    const int row = free_row[static_cast<std::size_t>(node)];
    if (row < 0) continue;
    mass_nodes_.push_back(node);
    diagonal_.push_back(find_place(row / 3, row / 3));
    pattern_.num_nodes = std::max(pattern_.num_nodes, row / 3 + 1);
  }
  const auto add_shares = [&](const auto& nodes) {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      for (std::size_t b = 0; b < nodes.size(); ++b) {
        const int row = free_row[static_cast<std::size_t>(nodes[a])];
        const int column = free_row[static_cast<std::size_t>(nodes[b])];
        if (column < 0 || row < column) continue;
        shares_.push_back({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b),
                           find_place(row / 3, column / 3)});
      }
    }
    shares_end_.push_back(shares_.size());
  };
  std::visit(
      [&](const auto& elements) {
        for (const auto& element : elements) add_shares(element.nodes);
      },
      body.elements());
  pattern_.values.assign(pattern_.places.size(), NodeBlock::Zero());
}

template <typename Element, typename Law>
void StepMatrix::AddElements(const std::vector<Element>& elements, const Law& law,
                             const Linearization& linearization, NodeMatrix* A) const {
  constexpr std::size_t kLanes = Pack::SizeAtCompileTime;
  const auto tangent_size = static_cast<std::size_t>(TangentSize(law));
  PointTangents<Element, Law> tangents;
  std::size_t next = 0;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (std::size_t q = 0; q < Element::kPoints; ++q) {
      const std::size_t point = e * Element::kPoints + q;
      tangents[q] = TangentAt(law, linearization.tangents.data() + point / kLanes * tangent_size,
                              static_cast<int>(point % kLanes));
    }
    const ElementStiffness<Element, Law> K(elements[e], law, tangents,
                                           linearization.stiffness_factor);
    for (; next < shares_end_[e]; ++next) {
      const Share& share = shares_[next];
      A->values[static_cast<std::size_t>(share.place)] += K(share.a, share.b);
    }
  }
}

void StepMatrix::Assemble(const Linearization& linearization, NodeMatrix* A) const {
  std::fill(A->values.begin(), A->values.end(), NodeBlock::Zero());
  std::visit(
      [&](const auto& elements, const auto& law) { AddElements(elements, law, linearization, A); },
      body_->elements(), body_->law());
  for (std::size_t k = 0; k < mass_nodes_.size(); ++k) {
    A->values[static_cast<std::size_t>(diagonal_[k])].topRows<3>().diagonal().array() +=
        linearization.mass_factor * body_->masses()(mass_nodes_[k]);
  }
}

}  // namespace vacuum_gripper_sim
