// Numbers: factorisation, solves and the inverse form.
#include "vacuum_gripper_sim/core/sparse_cholesky.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstring>
#include <numeric>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Panel = Eigen::Map<Eigen::MatrixXd>;
using ConstPanel = Eigen::Map<const Eigen::MatrixXd>;

}  // namespace

/// Extend-add: a child's update goes to the panel of its parent and to what the parent passes on.
void SparseCholesky::AddChild(const Supernode& child, const double* update, double* panel,
                              double* own_update, const Supernode& front) const {
  const Index child_size = 3 * child.num_below();
  const Index panel_stride = 3 * front.num_rows();
  const Index update_stride = 3 * front.num_below();
  for (std::size_t b = 0; b < child.in_parent.size(); ++b) {
    const int column_node = child.in_parent[b];
    const bool own = column_node < front.width;
    for (int j = 0; j < 3; ++j) {
      const double* source = update + (3 * static_cast<Index>(b) + j) * child_size;
      // Row r of the front stands at target[3 r].
      double* target = own ? panel + (3 * column_node + j) * panel_stride
                           : own_update + (3 * (column_node - front.width) + j) * update_stride -
                                 3 * front.width;
      for (std::size_t a = b; a < child.in_parent.size(); ++a) {
        double* to = target + 3 * child.in_parent[a];
        const double* from = source + 3 * a;
        to[0] += from[0];
        to[1] += from[1];
        to[2] += from[2];
      }
    }
  }
}

bool SparseCholesky::Factorize(const Eigen::SparseMatrix<double>& A) {
  std::fill(factor_.begin(), factor_.end(), 0.0);
  // Updates wait on a stack until their parent takes them: in postorder, a parent's children are on
  // top. Its own update is made above them and then moved down over them.
  std::vector<double> stack;
  std::vector<std::size_t> update_at(supernodes_.size(), 0);
  std::size_t top = 0;

  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    const Supernode& front = supernodes_[s];
    double* const panel = factor_.data() + front.offset;
    const Index rows = 3 * front.num_rows();
    const Index own = 3 * front.width;
    const Index below = rows - own;
    const auto update_size = static_cast<std::size_t>(below * below);
    if (stack.size() < top + update_size) stack.resize(2 * (top + update_size));
    double* const update = stack.data() + top;
    std::fill_n(update, update_size, 0.0);

    for (std::size_t e = front.entries_begin; e < front.entries_end; ++e) {
      panel[entries_[e].second] += A.valuePtr()[entries_[e].first];
    }
    for (const int c : front.children) {
      AddChild(supernodes_[static_cast<std::size_t>(c)],
               stack.data() + update_at[static_cast<std::size_t>(c)], panel, update, front);
    }

    Panel F(panel, rows, own);
    Eigen::Ref<Eigen::MatrixXd> diagonal = F.topRows(own);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(diagonal);
    if (llt.info() != Eigen::Success) return false;
    if (below > 0) {
      auto L_below = F.bottomRows(below);
      F.topRows(own).triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(
          L_below);
      Panel(update, below, below).selfadjointView<Eigen::Lower>().rankUpdate(L_below, -1.0);
    }

    const std::size_t bottom =
        front.children.empty() ? top : update_at[static_cast<std::size_t>(front.children.front())];
    if (bottom != top) std::memmove(stack.data() + bottom, update, update_size * sizeof(double));
    update_at[s] = bottom;
    top = bottom + update_size;
  }
  return true;
}

Eigen::VectorXd SparseCholesky::Solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd y(size_);
  for (std::size_t k = 0; k < node_at_.size(); ++k) {
    y.segment<3>(3 * static_cast<Index>(k)) = b.segment<3>(3 * node_at_[k]);
  }
  Eigen::VectorXd work;
  for (const Supernode& front : supernodes_) {
    const ConstPanel F(factor_.data() + front.offset, 3 * front.num_rows(), 3 * front.width);
    auto own = y.segment(3 * front.first, 3 * front.width);
    F.topRows(F.cols()).triangularView<Eigen::Lower>().solveInPlace(own);
    if (front.num_below() == 0) continue;
    work.noalias() = F.bottomRows(F.rows() - F.cols()) * own;
    for (int r = 0; r < front.num_below(); ++r) {
      y.segment<3>(3 * front.rows[static_cast<std::size_t>(front.width + r)]) -=
          work.segment<3>(3 * r);
    }
  }
  for (auto front = supernodes_.rbegin(); front != supernodes_.rend(); ++front) {
    const ConstPanel F(factor_.data() + front->offset, 3 * front->num_rows(), 3 * front->width);
    auto own = y.segment(3 * front->first, 3 * front->width);
    if (front->num_below() > 0) {
      work.resize(3 * front->num_below());
      for (int r = 0; r < front->num_below(); ++r) {
        work.segment<3>(3 * r) =
            y.segment<3>(3 * front->rows[static_cast<std::size_t>(front->width + r)]);
      }
      own.noalias() -= F.bottomRows(F.rows() - F.cols()).transpose() * work;
    }
    F.topRows(F.cols()).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  Eigen::VectorXd x(size_);
  for (std::size_t k = 0; k < node_at_.size(); ++k) {
    x.segment<3>(3 * node_at_[k]) = y.segment<3>(3 * static_cast<Index>(k));
  }
  return x;
}

Eigen::MatrixXd SparseCholesky::InverseForm(const Eigen::SparseMatrix<double>& B) const {
  // Columns in elimination order of their node: those in the subtree below a front, which are the
  // ones that reach it, then stand side by side.
  const auto num_columns = static_cast<std::size_t>(B.cols());
  std::vector<int> start(num_columns, 0);
  for (int c = 0; c < B.cols(); ++c) {
    const Eigen::SparseMatrix<double>::InnerIterator entry(B, c);
    if (entry)
      start[static_cast<std::size_t>(c)] = position_[static_cast<std::size_t>(entry.row() / 3)];
  }
  std::vector<int> order(num_columns);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return start[static_cast<std::size_t>(a)] < start[static_cast<std::size_t>(b)];
  });

  Eigen::MatrixXd sorted = Eigen::MatrixXd::Zero(B.cols(), B.cols());
  Eigen::MatrixXd Y = Eigen::MatrixXd::Zero(size_, B.cols());
  for (Index c = 0; c < B.cols(); ++c) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(B, order[static_cast<std::size_t>(c)]);
         entry; ++entry) {
      const int node = static_cast<int>(entry.row()) / 3;
      Y(3 * position_[static_cast<std::size_t>(node)] + entry.row() % 3, c) = entry.value();
    }
  }

  // First column in the subtree of each front, and one past the last that starts in it.
  std::vector<Index> begin(supernodes_.size());
  Index end = 0;
  Eigen::MatrixXd work;
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    const Supernode& front = supernodes_[s];
    begin[s] = end;
    for (const int c : front.children) {
      begin[s] = std::min(begin[s], begin[static_cast<std::size_t>(c)]);
    }
    while (end < B.cols() && start[static_cast<std::size_t>(order[static_cast<std::size_t>(end)])] <
                                 front.first + front.width) {
      ++end;
    }
    const Index width = end - begin[s];
    if (width == 0) continue;
    const ConstPanel F(factor_.data() + front.offset, 3 * front.num_rows(), 3 * front.width);
    auto own = Y.block(3 * front.first, begin[s], 3 * front.width, width);
    F.topRows(F.cols()).triangularView<Eigen::Lower>().solveInPlace(own);
    sorted.block(begin[s], begin[s], width, width)
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(own.transpose());
    if (front.num_below() == 0) continue;
    work.noalias() = F.bottomRows(F.rows() - F.cols()) * own;
    for (int r = 0; r < front.num_below(); ++r) {
      Y.block(3 * front.rows[static_cast<std::size_t>(front.width + r)], begin[s], 3, width) -=
          work.middleRows(3 * r, 3);
    }
  }

  Eigen::MatrixXd form(B.cols(), B.cols());
  for (Index j = 0; j < B.cols(); ++j) {
    for (Index i = j; i < B.cols(); ++i) {
      const int row = order[static_cast<std::size_t>(i)];
      const int column = order[static_cast<std::size_t>(j)];
      form(row, column) = sorted(i, j);
      form(column, row) = sorted(i, j);
    }
  }
  return form;
}

}  // namespace vacuum_gripper_sim
