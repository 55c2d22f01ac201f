#include "vacuum_gripper_sim/core/step_matrix.h"

#include <algorithm>
#include <map>
#include <utility>

namespace vacuum_gripper_sim {
namespace {

template <typename Element, typename Law>
void FindTangents(std::size_t e, const Law& law, const Linearization& linearization,
                  PointTangents<Element, Law>* tangents) {
  const Pack* tangent = linearization.tangents.data() + TangentsBegin<Element>(e / kPackLanes, law);
  for (std::size_t q = 0; q < Element::kPoints; ++q, tangent += TangentSize(law)) {
    (*tangents)[q] = TangentAt(law, tangent, static_cast<int>(e % kPackLanes));
  }
}

}  // namespace

StepMatrix::StepMatrix(const ElasticBody& body, const std::vector<int>& free_row) : body_(&body) {
  for (const int row : free_row) {
    if (row >= 0) pattern_.num_nodes = std::max(pattern_.num_nodes, row / 3 + 1);
  }
  std::visit([&](const auto& elements) { FindParts(elements, free_row); }, body.elements());
  pattern_.values.assign(pattern_.places.size(), NodeBlock::Zero());
}

template <typename Element>
void StepMatrix::FindParts(const std::vector<Element>& elements, const std::vector<int>& free_row) {
  std::vector<bool> has_mass(free_row.size(), false);
  for (std::size_t p = 0; p < kElementParts; ++p) {
    Part part;
    part.elements_begin = p * elements.size() / kElementParts;
    part.elements_end = (p + 1) * elements.size() / kElementParts;
    part.blocks_begin = blocks_.size();
    part.masses_begin = masses_.size();
    part.places_begin = static_cast<std::ptrdiff_t>(pattern_.places.size());
    std::map<std::pair<int, int>, int> place_of;  // by row and column, row >= column
    const auto find_place = [&](int row, int column) {
      const auto [place, is_new] =
          place_of.emplace(std::pair(row, column), static_cast<int>(pattern_.places.size()));
      if (is_new) pattern_.places.push_back({row, column});
      return place->second;
    };
    for (std::size_t e = part.elements_begin; e < part.elements_end; ++e) {
      const auto& nodes = elements[e].nodes;
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        const auto node = static_cast<std::size_t>(nodes[a]);
        const int row = free_row[node];
        if (row < 0) continue;
        if (!has_mass[node]) masses_.push_back({nodes[a], find_place(row / 3, row / 3)});
        has_mass[node] = true;
        for (std::size_t b = 0; b < nodes.size(); ++b) {
          const int column = free_row[static_cast<std::size_t>(nodes[b])];
          if (column < 0 || row < column) continue;
          blocks_.push_back({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b),
                             find_place(row / 3, column / 3)});
        }
      }
      blocks_end_.push_back(blocks_.size());
    }
    part.masses_end = masses_.size();
    part.places_end = static_cast<std::ptrdiff_t>(pattern_.places.size());
    parts_.push_back(part);
  }
}

void StepMatrix::AssemblePart(const Part& part, const Linearization& linearization,
                              NodeMatrix* A) const {
  std::fill(A->values.begin() + part.places_begin, A->values.begin() + part.places_end,
            NodeBlock::Zero());
  std::size_t next = part.blocks_begin;
  const auto add_elements = [&](const auto& elements, const auto& law) {
    using Element = typename std::decay_t<decltype(elements)>::value_type;
    using Law = std::decay_t<decltype(law)>;
    PointTangents<Element, Law> tangents;
    for (std::size_t e = part.elements_begin; e < part.elements_end; ++e) {
      FindTangents<Element>(e, law, linearization, &tangents);
      const ElementStiffness<Element, Law> K(elements[e], law, tangents,
                                             linearization.stiffness_factor);
      for (; next < blocks_end_[e]; ++next) {
        const ElementBlock& block = blocks_[next];
        A->values[static_cast<std::size_t>(block.place)] += K(block.a, block.b);
      }
    }
  };
  std::visit(add_elements, body_->elements(), body_->law());
  for (std::size_t k = part.masses_begin; k < part.masses_end; ++k) {
    A->values[static_cast<std::size_t>(masses_[k].place)].topRows<3>().diagonal().array() +=
        linearization.mass_factor * body_->masses()(masses_[k].node);
  }
}

void StepMatrix::Assemble(const Linearization& linearization, NodeMatrix* A, Crew* crew) const {
  const auto assemble = [&](int part, int /*member*/) {
    AssemblePart(parts_[static_cast<std::size_t>(part)], linearization, A);
  };
  Share(crew, static_cast<int>(parts_.size()), assemble);
}

}  // namespace vacuum_gripper_sim
