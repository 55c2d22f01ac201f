#include "vacuum_gripper_sim/core/step_matrix.h"

#include <algorithm>

namespace vacuum_gripper_sim {

StepMatrix::StepMatrix(const ElasticBody& body, const std::vector<int>& free_row) : body_(&body) {
  const auto row_of = [&](int node) { return free_row[static_cast<std::size_t>(node)]; };
  std::vector<Eigen::Triplet<double>> entries;
  int size = 0;
  for (int node = 0; node < body.num_nodes(); ++node) {
    if (row_of(node) >= 0) mass_nodes_.push_back(node);
    size = std::max(size, row_of(node) + 3);
  }
  const auto visit_blocks = [&](const auto& function) {
    std::visit(
        [&](const auto& elements) {
          for (const auto& element : elements) {
            for (std::size_t a = 0; a < element.nodes.size(); ++a) {
              for (std::size_t b = 0; b < element.nodes.size(); ++b) {
                const int row = row_of(element.nodes[a]);
                const int column = row_of(element.nodes[b]);
                if (column >= 0 && row >= column) function(a, b, row, column);
              }
            }
            blocks_end_.push_back(blocks_.size());
          }
        },
        body.elements());
  };
  visit_blocks([&](std::size_t, std::size_t, int row, int column) {
    for (int j = 0; j < 3; ++j) {
      for (int i = row == column ? j : 0; i < 3; ++i) {
        entries.emplace_back(row + i, column + j, 0.0);
      }
    }
  });
  pattern_.resize(size, size);
  pattern_.setFromTriplets(entries.begin(), entries.end());

  blocks_end_.clear();
  visit_blocks([&](std::size_t a, std::size_t b, int row, int column) {
    Block block;
    block.a = static_cast<std::uint8_t>(a);
    block.b = static_cast<std::uint8_t>(b);
    block.diagonal = row == column;
    for (int j = 0; j < 3; ++j) {
      block.offsets[static_cast<std::size_t>(j)] =
          OffsetOf(block.diagonal ? row + j : row, column + j);
    }
    blocks_.push_back(block);
  });
  for (const int node : mass_nodes_) {
    for (int i = 0; i < 3; ++i)
      mass_offsets_.push_back(OffsetOf(row_of(node) + i, row_of(node) + i));
  }
}

/// Of an entry in the array of values.
int StepMatrix::OffsetOf(int row, int column) const {
  const int* const begin = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[column];
  const int* const end = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[column + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - pattern_.innerIndexPtr());
}

template <typename Element, typename Law>
void StepMatrix::AddElements(const std::vector<Element>& elements, const Law& law,
                             const Linearization& linearization, double* values) const {
  constexpr std::size_t kLanes = Pack::SizeAtCompileTime;
  const auto tangent_size = static_cast<std::size_t>(TangentSize(law));
  std::array<typename Law::Tangent, Element::kPoints> tangents;
  typename Element::Stiffness K_e;
  auto block = blocks_.begin();
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (std::size_t q = 0; q < Element::kPoints; ++q) {
      const std::size_t point = e * Element::kPoints + q;
      tangents[q] = TangentAt(law, linearization.tangents.data() + point / kLanes * tangent_size,
                              static_cast<int>(point % kLanes));
    }
    ElementStiffness(elements[e], law, tangents, &K_e);
    const auto end = blocks_.begin() + static_cast<std::ptrdiff_t>(blocks_end_[e]);
    for (; block != end; ++block) {
      const Eigen::Matrix3d K_ab =
          linearization.stiffness_factor * Element::Block(K_e, block->a, block->b);
      for (int j = 0; j < 3; ++j) {
        double* const column = values + block->offsets[static_cast<std::size_t>(j)];
        const int first = block->diagonal ? j : 0;
        for (int i = first; i < 3; ++i) column[i - first] += K_ab(i, j);
      }
    }
  }
}

void StepMatrix::Assemble(const Linearization& linearization,
                          Eigen::SparseMatrix<double>* A) const {
  double* const values = A->valuePtr();
  std::fill_n(values, A->nonZeros(), 0.0);
  std::visit([&](const auto& elements,
                 const auto& law) { AddElements(elements, law, linearization, values); },
             body_->elements(), body_->law());
  for (std::size_t k = 0; k < mass_nodes_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      values[mass_offsets_[3 * k + i]] +=
          linearization.mass_factor * body_->masses()(mass_nodes_[k]);
    }
  }
}

}  // namespace vacuum_gripper_sim
