// Structure: everything that depends on the sparsity alone.
#include <algorithm>
#include <numeric>
#include <utility>

#include "vacuum_gripper_sim/core/sparse_cholesky.h"

namespace vacuum_gripper_sim {
namespace {

NodeGraph MakeNodeGraph(const NodeMatrix& A) {
  NodeGraph graph(static_cast<std::size_t>(A.num_nodes));
  for (const auto& [row, column] : A.places) {
    if (row == column) continue;
    graph[static_cast<std::size_t>(row)].push_back(column);
    graph[static_cast<std::size_t>(column)].push_back(row);
  }
  for (auto& neighbours : graph) {
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  }
  return graph;
}

/// Is merging worth its zeros? Small fronts are slow: there, many zeros are worth it.
bool WorthMerging(int merged_width, double zero_share) {
  if (merged_width <= 2) return true;
  if (merged_width <= 6) return zero_share < 0.6;
  if (merged_width <= 16) return zero_share < 0.15;
  return zero_share < 0.05;
}

}  // namespace

void SparseCholesky::Analyze(const NodeMatrix& A, Crew* crew) {
  crew_ = crew;
  size_ = 3 * A.num_nodes;
  const NodeGraph graph = MakeNodeGraph(A);
  elimination_ = FindEliminationOrder(graph);
  FindPieces();
  FindSupernodes(graph);
  MergeSmallSupernodes();
  LinkSupernodes();
  CutIntoBranches();
  PlaceUpdates();
  MapEntries(A);
}

/// Each tree of the elimination forest is a piece.
void SparseCholesky::FindPieces() {
  num_pieces_ = 0;
  piece_of_.resize(elimination_.parent.size());
  for (std::size_t k = elimination_.parent.size(); k-- > 0;) {
    piece_of_[static_cast<std::size_t>(elimination_.node_at[k])] =
        elimination_.parent[k] < 0
            ? num_pieces_++
            : PieceOf(elimination_.node_at[static_cast<std::size_t>(elimination_.parent[k])]);
  }
}

void SparseCholesky::FindSupernodes(const NodeGraph& graph) {
  // Structure of every column of L: its own entries of A and what its children leave to it.
  std::vector<std::vector<int>> structure(graph.size());
  for (std::size_t k = 0; k < graph.size(); ++k) {
    std::vector<int>& rows = structure[k];
    rows.push_back(static_cast<int>(k));
    for (const int neighbour : graph[static_cast<std::size_t>(elimination_.node_at[k])]) {
      const int row = elimination_.position[static_cast<std::size_t>(neighbour)];
      if (row > static_cast<int>(k)) rows.push_back(row);
    }
  }
  for (std::size_t k = 0; k < graph.size(); ++k) {
    std::vector<int>& rows = structure[k];
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    if (elimination_.parent[k] < 0) continue;
    std::vector<int>& above = structure[static_cast<std::size_t>(elimination_.parent[k])];
    above.insert(above.end(), rows.begin() + 1, rows.end());
    // Kept short, or a parent of many children grows quadratically.
    std::sort(above.begin(), above.end());
    above.erase(std::unique(above.begin(), above.end()), above.end());
  }

  supernodes_.clear();
  for (std::size_t k = 0; k < graph.size(); ++k) {
    const bool continues = k > 0 && elimination_.parent[k - 1] == static_cast<int>(k) &&
                           structure[k - 1].size() == structure[k].size() + 1;
    if (continues) {
      ++supernodes_.back().width;
    } else {
      Supernode supernode;
      supernode.first = static_cast<int>(k);
      supernode.width = 1;
      supernode.rows = structure[k];
      supernodes_.push_back(std::move(supernode));
    }
  }
}

/// Merges a supernode into the one eliminated right after it, where that is its parent.
void SparseCholesky::MergeSmallSupernodes() {
  std::vector<Supernode> merged;
  std::vector<double> zeros;  // blocks stored for nothing, by merged supernode
  for (Supernode& supernode : supernodes_) {
    merged.push_back(std::move(supernode));
    zeros.push_back(0.0);
    while (merged.size() > 1) {
      Supernode& lower = merged[merged.size() - 2];
      Supernode& upper = merged.back();
      const bool is_parent =
          lower.num_below() > 0 &&
          lower.rows[static_cast<std::size_t>(lower.width)] < upper.first + upper.width;
      if (!is_parent) break;
      const double added =
          static_cast<double>(lower.width) * (lower.width + upper.num_rows() - lower.num_rows());
      const int width = lower.width + upper.width;
      const double blocks = static_cast<double>(width) * (lower.width + upper.num_rows());
      const double all_zeros = zeros[zeros.size() - 2] + zeros.back() + added;
      if (!WorthMerging(width, all_zeros / blocks)) break;
      std::vector<int> rows(static_cast<std::size_t>(lower.width));
      std::iota(rows.begin(), rows.end(), lower.first);
      rows.insert(rows.end(), upper.rows.begin(), upper.rows.end());
      lower.rows = std::move(rows);
      lower.width = width;
      zeros[zeros.size() - 2] = all_zeros;
      merged.pop_back();
      zeros.pop_back();
    }
  }
  supernodes_ = std::move(merged);
}

void SparseCholesky::LinkSupernodes() {
  supernode_of_.resize(elimination_.node_at.size());
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    const Supernode& supernode = supernodes_[s];
    std::fill_n(supernode_of_.begin() + supernode.first, supernode.width, static_cast<int>(s));
  }
  std::size_t offset = 0;
  largest_front_ = 0;
  num_rows_ = 0;
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    Supernode& supernode = supernodes_[s];
    largest_front_ = std::max<Eigen::Index>(largest_front_, 3 * supernode.num_rows());
    supernode.offset = offset;
    supernode.rows_before = num_rows_;
    num_rows_ += 3 * supernode.num_rows();
    offset += 9 * supernode.rows.size() * static_cast<std::size_t>(supernode.width);
    if (supernode.num_below() == 0) continue;
    supernode.parent = supernode_of_[static_cast<std::size_t>(
        supernode.rows[static_cast<std::size_t>(supernode.width)])];
    Supernode& parent = supernodes_[static_cast<std::size_t>(supernode.parent)];
    parent.children.push_back(static_cast<int>(s));
    for (std::size_t r = static_cast<std::size_t>(supernode.width); r < supernode.rows.size();
         ++r) {
      const auto place =
          std::lower_bound(parent.rows.begin(), parent.rows.end(), supernode.rows[r]);
      supernode.in_parent.push_back(static_cast<int>(place - parent.rows.begin()));
      if (supernode.in_parent.back() < parent.width) ++supernode.num_in_own;
    }
  }
  factor_size_ = offset;
}

void SparseCholesky::CutIntoBranches() {
  constexpr double kCostOfANumber = 16.0;  // to clear it and to add to it, in operations
  constexpr double kWorthSharing = 1e+5;   // numbers of a factor, that a solve reads twice
  std::vector<int> parent;
  std::vector<double> cost, numbers;
  for (const Supernode& front : supernodes_) {
    const double rows = 3.0 * front.num_rows();
    const double own = 3.0 * front.width;
    parent.push_back(front.parent);
    // Columns of rows, rows - 1, ... numbers, each of which changes what is to its right and below.
    cost.push_back(own * (rows * rows - rows * own + own * own / 3.0) +
                   kCostOfANumber * rows * rows);
    numbers.push_back(rows * own);
  }
  const int num_threads = crew_ != nullptr ? crew_->size() : 1;
  branches_ = vacuum_gripper_sim::CutIntoBranches(parent, cost, num_threads);
  const double all_numbers = std::accumulate(numbers.begin(), numbers.end(), 0.0);
  in_solves_ = vacuum_gripper_sim::CutIntoBranches(parent, numbers,
                                                   all_numbers > kWorthSharing ? num_threads : 1);
}

void SparseCholesky::PlaceUpdates() {
  for (auto front = supernodes_.rbegin(); front != supernodes_.rend(); ++front) {
    if (front->parent >= 0) {
      front->depth = supernodes_[static_cast<std::size_t>(front->parent)].depth + 1;
    }
  }
  update_sizes_ = {};
  for (const auto [begin, end] : branches_.branches) {
    // Each branch has stacks of its own, above those of the ones before.
    std::array<std::size_t, 2> top = update_sizes_;
    for (std::size_t s = begin; s < end; ++s) {
      Supernode& front = supernodes_[s];
      const auto own = static_cast<std::size_t>(front.depth % 2);
      front.update_offset = top[own];
      top[own] += static_cast<std::size_t>(9 * front.num_below() * front.num_below());
      update_sizes_[own] = std::max(update_sizes_[own], top[own]);
      if (front.children.empty()) continue;
      const auto first = static_cast<std::size_t>(front.children.front());
      if (first >= begin) top[1 - own] = supernodes_[first].update_offset;
    }
  }
}

void SparseCholesky::MapEntries(const NodeMatrix& A) {
  std::vector<std::vector<Entry>> found(supernodes_.size());
  for (std::size_t block = 0; block < A.places.size(); ++block) {
    // In elimination order; the later one is the row of L.
    int row = elimination_.position[static_cast<std::size_t>(A.places[block].row)];
    int column = elimination_.position[static_cast<std::size_t>(A.places[block].column)];
    const bool mirrored = row < column;
    if (mirrored) std::swap(row, column);
    const int s = supernode_of_[static_cast<std::size_t>(column)];
    const Supernode& front = supernodes_[static_cast<std::size_t>(s)];
    const auto place = std::lower_bound(front.rows.begin(), front.rows.end(), row);
    const Eigen::Index panel_row = 3 * (place - front.rows.begin());
    const Eigen::Index panel_column = 3 * (column - front.first);
    found[static_cast<std::size_t>(s)].push_back(
        {block, panel_row + panel_column * 3 * front.num_rows(), mirrored});
  }
  entries_.clear();
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    supernodes_[s].entries_begin = entries_.size();
    entries_.insert(entries_.end(), found[s].begin(), found[s].end());
    supernodes_[s].entries_end = entries_.size();
  }
}

}  // namespace vacuum_gripper_sim
