// Numbers: factorisation, solves and the inverse form.
#include "vacuum_gripper_sim/core/sparse_cholesky.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "dense_kernels.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Few enough for several threads to have some, and for a front's part of them to stay in cache.
constexpr Index kColumnsAtATime = 64;

/// Extend-add: columns [begin, end) of a child's update, #rows square, go into its parent's front.
/// @param in_parent Place of every node of the update in the front.
/// @param target Where column 0, row 0 of the front would stand. @param stride Of its columns.
template <typename Scalar>
void AddChild(const Scalar* update, const std::vector<int>& in_parent, std::size_t begin,
              std::size_t end, Scalar* target, Index stride) {
  const auto update_stride = 3 * static_cast<Index>(in_parent.size());
  for (std::size_t b = begin; b < end; ++b) {
    for (std::size_t a = b; a < in_parent.size(); ++a) {
      const Scalar* from =
          update + 3 * (static_cast<Index>(b) * update_stride + static_cast<Index>(a));
      Scalar* to = target + 3 * (in_parent[b] * stride + in_parent[a]);
      for (int j = 0; j < 3; ++j, from += update_stride, to += stride) {
        // All sums before one is stored: the compiler may then make them side by side.
        const Scalar x = to[0] + from[0], y = to[1] + from[1], z = to[2] + from[2];
        to[0] = x;
        to[1] = y;
        to[2] = z;
      }
    }
  }
}

}  // namespace

bool SparseCholesky::Factorize(const NodeMatrix& A, Precision precision) {
  if (precision == Precision::kSingle && !std::holds_alternative<Numbers<float>>(numbers_)) {
    numbers_ = Numbers<float>();
  } else if (precision == Precision::kDouble &&
             !std::holds_alternative<Numbers<double>>(numbers_)) {
    numbers_ = Numbers<double>();
  }
  std::atomic<bool> positive_definite{true};
  const auto factorize = [&](auto& numbers) {
    numbers.factor.resize(factor_size_);
    for (std::size_t i = 0; i < 2; ++i) numbers.updates[i].resize(update_sizes_[i]);
    const auto eliminate = [&](int branch, int /*member*/) {
      const auto [begin, end] = branches_.branches[static_cast<std::size_t>(branch)];
      for (std::size_t s = begin; s < end && positive_definite; ++s) {
        if (!EliminateFront(supernodes_[s], A, &numbers)) positive_definite = false;
      }
    };
    Share(crew_, branches_.forest, eliminate);
  };
  std::visit(factorize, numbers_);
  return positive_definite;
}

VectorXd SparseCholesky::Solve(const VectorXd& b) const {
  VectorXd y, x;
  Eliminate(b, &y);
  BackSubstitute(y, &x);
  return x;
}

void SparseCholesky::Eliminate(const VectorXd& b, VectorXd* y) const {
  std::visit([&](const auto& numbers) { Eliminate(numbers, b, y); }, numbers_);
}

void SparseCholesky::BackSubstitute(const VectorXd& y, VectorXd* x) const {
  std::visit([&](const auto& numbers) { BackSubstitute(numbers, y, x); }, numbers_);
}

void SparseCholesky::EliminateColumns(const std::vector<NodeColumn>& B,
                                      EliminatedColumns* Y) const {
  std::visit([&](const auto& numbers) { EliminateColumns(numbers, B, Y); }, numbers_);
}

/// @returns false if A is not positive definite.
template <typename Scalar>
bool SparseCholesky::EliminateFront(const Supernode& front, const NodeMatrix& A,
                                    Numbers<Scalar>* numbers) const {
  Scalar* const panel = numbers->factor.data() + front.offset;
  const Index rows = 3 * front.num_rows();
  const Index own = 3 * front.width;
  const Index below = rows - own;
  std::fill_n(panel, rows * own, Scalar(0));
  for (std::size_t e = front.entries_begin; e < front.entries_end; ++e) {
    const NodeBlock& block = A.values[entries_[e].block];
    Scalar* column = panel + entries_[e].offset;
    for (int j = 0; j < 3; ++j, column += rows) {
      for (int i = 0; i < 3; ++i) {
        column[i] += static_cast<Scalar>(entries_[e].mirrored ? block(j, i) : block(i, j));
      }
    }
  }
  for (const int c : front.children) {
    const Supernode& child = supernodes_[static_cast<std::size_t>(c)];
    AddChild(numbers->UpdateOf(child), child.in_parent, 0, child.num_in_own, panel, rows);
  }
  if (!FactorizePanel(rows, own, panel)) return false;
  if (below == 0) return true;
  Scalar* const update = numbers->UpdateOf(front);
  NegativeSquare(below, own, panel + own, rows, update);
  for (const int c : front.children) {
    const Supernode& child = supernodes_[static_cast<std::size_t>(c)];
    AddChild(numbers->UpdateOf(child), child.in_parent, child.num_in_own, child.in_parent.size(),
             update - own * (below + 1), below);
  }
  return true;
}

template <typename Scalar>
void SparseCholesky::Eliminate(const Numbers<Scalar>& numbers, const VectorXd& b,
                               VectorXd* y) const {
  auto all_rows = numbers.rows.Shape(num_rows_);
  y->resize(size_);
  const auto eliminate = [&](const Supernode& front) {
    const Index own = 3 * front.width;
    auto rows = all_rows.segment(front.rows_before, 3 * front.num_rows());
    for (int k = 0; k < front.width; ++k) {
      const int node = elimination_.node_at[static_cast<std::size_t>(front.first + k)];
      rows.template segment<3>(3 * k) = b.segment<3>(3 * node).template cast<Scalar>();
    }
    rows.tail(rows.size() - own).setZero();
    for (const int c : front.children) {
      const Supernode& child = supernodes_[static_cast<std::size_t>(c)];
      Index from = child.rows_before + 3 * child.width;
      for (const int place : child.in_parent) {
        rows.template segment<3>(3 * place) += all_rows.template segment<3>(from);
        from += 3;
      }
    }
    EliminateVector(rows.size(), own, numbers.factor.data() + front.offset, rows.data());
    y->segment(3 * front.first, own) = rows.head(own).template cast<double>();
  };
  Share(crew_, in_solves_.forest, [&](int branch, int /*member*/) {
    const auto [begin, end] = in_solves_.branches[static_cast<std::size_t>(branch)];
    for (std::size_t s = begin; s < end; ++s) eliminate(supernodes_[s]);
  });
}

template <typename Scalar>
void SparseCholesky::BackSubstitute(const Numbers<Scalar>& numbers, const VectorXd& y,
                                    VectorXd* x) const {
  auto z = numbers.solution.Shape(size_);
  auto all_rows = numbers.rows.Shape(num_rows_);
  x->resize(size_);
  const auto substitute = [&](const Supernode& front) {
    const Index own = 3 * front.width;
    auto rows = all_rows.segment(front.rows_before, 3 * front.num_rows());
    rows.head(own) = y.segment(3 * front.first, own).template cast<Scalar>();
    for (int r = front.width; r < front.num_rows(); ++r) {
      rows.template segment<3>(3 * r) =
          z.template segment<3>(3 * front.rows[static_cast<std::size_t>(r)]);
    }
    BackSubstituteVector(rows.size(), own, numbers.factor.data() + front.offset, rows.data());
    z.segment(3 * front.first, own) = rows.head(own);
    for (int k = 0; k < front.width; ++k) {
      const int node = elimination_.node_at[static_cast<std::size_t>(front.first + k)];
      x->segment<3>(3 * node) = rows.template segment<3>(3 * k).template cast<double>();
    }
  };
  ShareDownwards(crew_, in_solves_.forest, [&](int branch, int /*member*/) {
    const auto [begin, end] = in_solves_.branches[static_cast<std::size_t>(branch)];
    for (std::size_t s = end; s-- > begin;) substitute(supernodes_[s]);
  });
}

/// Sorts the columns, gives a block to every front that one reaches, and fills in B.
/// @returns the values of Y.
template <typename Scalar>
std::vector<Scalar>& SparseCholesky::LayOutColumns(const std::vector<NodeColumn>& B,
                                                   EliminatedColumns* Y) const {
  const auto start = [&](int c) {
    return elimination_.position[static_cast<std::size_t>(B[static_cast<std::size_t>(c)].node)];
  };
  Y->order_.resize(B.size());
  std::iota(Y->order_.begin(), Y->order_.end(), 0);
  std::sort(Y->order_.begin(), Y->order_.end(),
            [&](int a, int b) { return std::pair(start(a), a) < std::pair(start(b), b); });

  block_of_.assign(supernodes_.size(), -1);
  Y->blocks_.clear();
  Y->blocks_.reserve(supernodes_.size());
  std::size_t offset = 0;
  std::size_t end = 0;
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    const Supernode& front = supernodes_[s];
    auto begin = static_cast<Index>(end);
    for (const int c : front.children) {
      const int block = block_of_[static_cast<std::size_t>(c)];
      if (block >= 0) begin = std::min(begin, Y->blocks_[static_cast<std::size_t>(block)].column);
    }
    while (end < B.size() && start(Y->order_[end]) < front.first + front.width) ++end;
    const Index num_columns = static_cast<Index>(end) - begin;
    if (num_columns == 0) continue;
    block_of_[s] = static_cast<int>(Y->blocks_.size());
    Y->blocks_.push_back({3 * front.first, 3 * front.width, begin, num_columns, offset});
    offset += static_cast<std::size_t>(3 * front.width * num_columns);
  }
  using ColumnNumbers = EliminatedColumns::Numbers<Scalar>;
  if (!std::holds_alternative<ColumnNumbers>(Y->numbers_)) Y->numbers_ = ColumnNumbers();
  std::vector<Scalar>& values = std::get<ColumnNumbers>(Y->numbers_).values;
  values.assign(offset, Scalar(0));
  for (std::size_t k = 0; k < B.size(); ++k) {
    const int position = start(Y->order_[k]);
    const int s = supernode_of_[static_cast<std::size_t>(position)];
    const auto& block =
        Y->blocks_[static_cast<std::size_t>(block_of_[static_cast<std::size_t>(s)])];
    Y->Values(&values, block)
        .row(static_cast<Index>(k) - block.column)
        .template segment<3>(3 * position - block.row) =
        B[static_cast<std::size_t>(Y->order_[k])].value.transpose().template cast<Scalar>();
  }
  return values;
}

template <typename Scalar>
void SparseCholesky::EliminateColumns(const Numbers<Scalar>& numbers,
                                      const std::vector<NodeColumn>& B,
                                      EliminatedColumns* Y) const {
  std::vector<Scalar>& values = LayOutColumns<Scalar>(B, Y);
  const Index num_columns = Y->num_columns();
  const Index num_parts = (num_columns + kColumnsAtATime - 1) / kColumnsAtATime;
  numbers.updates_of_columns.resize(static_cast<std::size_t>(crew_ != nullptr ? crew_->size() : 1));
  for (MatrixMemory<Scalar>& updates : numbers.updates_of_columns) {
    updates.Shape(kColumnsAtATime, largest_front_);  // whichever thread will need it
  }
  const auto eliminate = [&](int part, int member) {
    const Index begin = part * kColumnsAtATime;
    EliminateColumns(numbers, begin, std::min(begin + kColumnsAtATime, num_columns),
                     &numbers.updates_of_columns[static_cast<std::size_t>(member)], *Y, &values);
  };
  Share(crew_, static_cast<int>(num_parts), eliminate);
}

/// Columns [begin, end), of which every front works on those that reach it.
template <typename Scalar>
void SparseCholesky::EliminateColumns(const Numbers<Scalar>& numbers, Index begin, Index end,
                                      MatrixMemory<Scalar>* updates, const EliminatedColumns& Y,
                                      std::vector<Scalar>* values) const {
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    if (block_of_[s] < 0) continue;
    const Supernode& front = supernodes_[s];
    const EliminatedColumns::Block& block = Y.blocks_[static_cast<std::size_t>(block_of_[s])];
    const Index first = std::max(begin, block.column);
    const Index num_columns = std::min(end, block.column + block.num_columns) - first;
    if (num_columns <= 0) continue;
    const Scalar* const panel = numbers.factor.data() + front.offset;
    const Index rows = 3 * front.num_rows();
    const Index own = 3 * front.width;
    Scalar* const Y_own = values->data() + block.offset + (first - block.column);
    SolveOnTheRight(num_columns, own, panel, rows, Y_own, block.num_columns);
    if (rows == own) continue;
    auto update = updates->Shape(num_columns, rows - own);
    NegativeProduct(num_columns, rows - own, own, Y_own, block.num_columns, panel + own, rows,
                    update.data());
    for (int r = 0; r < front.num_below(); ++r) {
      const int position = front.rows[static_cast<std::size_t>(front.width + r)];
      const int above = supernode_of_[static_cast<std::size_t>(position)];
      const auto& target =
          Y.blocks_[static_cast<std::size_t>(block_of_[static_cast<std::size_t>(above)])];
      EliminatedColumns::Values(values, target)
          .block(first - target.column, 3 * position - target.row, num_columns, 3) +=
          update.middleCols(3 * r, 3);
    }
  }
}

}  // namespace vacuum_gripper_sim
