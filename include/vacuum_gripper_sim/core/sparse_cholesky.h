#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "vacuum_gripper_sim/core/crew.h"
#include "vacuum_gripper_sim/core/eliminated_columns.h"
#include "vacuum_gripper_sim/core/elimination_branches.h"
#include "vacuum_gripper_sim/core/elimination_order.h"
#include "vacuum_gripper_sim/core/matrix_memory.h"
#include "vacuum_gripper_sim/core/node_matrix.h"
#include "vacuum_gripper_sim/core/parameters.h"

namespace vacuum_gripper_sim {

/** Multifrontal Cholesky factorisation P A P^T = L L^T of a sparse symmetric positive definite
 matrix made of 3 by 3 node blocks ([Duff 1983], [Liu 1992]).

 The elimination works on dense fronts, so that the arithmetic runs in blocked kernels: on the
 quadratic cup several times faster than a column-by-column factorisation. Ordering
 (FindEliminationOrder() on the graph of nodes) and symbolic factorisation are done once by
 Analyze().

 The factor's numbers may be in single precision, for twice the speed; what goes in and comes out is
 in double precision all the same, with an error that |L| |L^T| and single rounding make.

 Factorisations, solves and columns can be shared among the threads of a crew; the numbers are the
 same with any. Solves and columns share working memory: one call at a time.

 [Duff 1983] I. S. Duff, J. K. Reid, "The multifrontal solution of indefinite sparse symmetric
 linear equations", ACM TOMS 9(3). [Liu 1992] J. W. H. Liu, "The multifrontal method for sparse
 matrix solution: theory and practice", SIAM Review 34(1). */
class SparseCholesky {
 public:
  /// Finds ordering and structure.
  /// @param crew Shares the work from now on, and must outlive this; none: the calling thread
  /// alone.
  void Analyze(const NodeMatrix& A, Crew* crew = nullptr);
  /// From now on without a crew.
  void WorkAlone() { crew_ = nullptr; }
  bool analyzed() const { return !supernodes_.empty(); }
  /// Into which a factorisation falls for the crew; 1 without.
  int num_branches() const { return static_cast<int>(branches_.branches.size()); }
  /// The same of a solve; 1 where it is so short that calling the crew would take longer.
  int num_branches_in_solves() const { return static_cast<int>(in_solves_.branches.size()); }
  /// A falls into this many pieces without entries between them,
  int num_pieces() const { return num_pieces_; }
  /// of which a node belongs to one.
  int PieceOf(int node) const { return piece_of_[static_cast<std::size_t>(node)]; }

  /// Factorises. @param A Its places are those of Analyze().
  /// @returns false if A is not positive definite, to the given precision; the factor is unusable
  /// then.
  bool Factorize(const NodeMatrix& A, Precision precision = Precision::kDouble);

  /// Exchanges the factors of two that have been analysed alike.
  void SwapFactor(SparseCholesky* other) { numbers_.swap(other->numbers_); }

  /// Of the last factorisation.
  Precision precision() const {
    return numbers_.index() == 0 ? Precision::kDouble : Precision::kSingle;
  }

  /// A^-1 b.
  Eigen::VectorXd Solve(const Eigen::VectorXd& b) const;
  // In neither half of a solve may both vectors be the same one.
  /// y = L^-1 P b, the first half of a solve; in elimination order.
  void Eliminate(const Eigen::VectorXd& b, Eigen::VectorXd* y) const;
  /// x = P^T L^-T y, the second half.
  void BackSubstitute(const Eigen::VectorXd& y, Eigen::VectorXd* x) const;

  /// Y = L^-1 P B front by front, on the columns that reach it. @param[out] Y Keeps its storage
  /// from call to call.
  void EliminateColumns(const std::vector<NodeColumn>& B, EliminatedColumns* Y) const;

 private:
  /// Columns eliminated together, as one dense front.
  struct Supernode {
    int first{0};                ///< First node, in elimination order.
    int width{0};                ///< Nodes eliminated here.
    std::vector<int> rows;       ///< Nodes of the front, ascending; the first `width` are its own.
    int parent{-1};              ///< Supernode that takes the update; -1: a root.
    std::vector<int> in_parent;  ///< Place in the parent's rows of every row beyond the own ones.
    std::size_t num_in_own{0};   ///< How many of these are the parent's own nodes: the first.
    std::vector<int> children;
    int depth{0};                  ///< Supernodes above.
    std::size_t update_offset{0};  ///< Of the update in Numbers::updates[depth % 2].
    std::size_t offset{
        0};  ///< Of the front's panel in Numbers::factor: 3 #rows by 3 width, column-major.
    Eigen::Index rows_before{0};                   ///< Of other fronts in Numbers::rows; scalars.
    std::size_t entries_begin{0}, entries_end{0};  ///< Of entries_: A's blocks that enter here.

    int num_rows() const { return static_cast<int>(rows.size()); }
    int num_below() const { return num_rows() - width; }
  };

  /// A block of A in a front's panel.
  struct Entry {
    std::size_t block{0};
    Eigen::Index offset{0};  ///< Of its first number in the panel.
    bool mirrored{false};    ///< Its node of the column is eliminated after that of the row.
  };

  /// Values of the factor, and updates that wait for their parent, on two stacks for each branch:
  /// in postorder a front finds its children on top of one and leaves its own update on the other.
  template <typename Scalar>
  struct Numbers {
    std::vector<Scalar> factor;
    std::array<std::vector<Scalar>, 2> updates;
    mutable MatrixMemory<Scalar> solution, rows;  // of solves: of all nodes, of the fronts
    mutable std::vector<MatrixMemory<Scalar>> updates_of_columns;  // by member of the crew

    /// What a front leaves to its parent, 3 #below square.
    Scalar* UpdateOf(const Supernode& front) {
      return updates[static_cast<std::size_t>(front.depth % 2)].data() + front.update_offset;
    }
  };

  void FindPieces();
  void FindSupernodes(const NodeGraph& graph);
  void MergeSmallSupernodes();
  void LinkSupernodes();
  void CutIntoBranches();
  void PlaceUpdates();
  void MapEntries(const NodeMatrix& A);
  template <typename Scalar>
  std::vector<Scalar>& LayOutColumns(const std::vector<NodeColumn>& B, EliminatedColumns* Y) const;
  template <typename Scalar>
  bool EliminateFront(const Supernode& front, const NodeMatrix& A, Numbers<Scalar>* numbers) const;
  template <typename Scalar>
  void Eliminate(const Numbers<Scalar>& numbers, const Eigen::VectorXd& b,
                 Eigen::VectorXd* y) const;
  template <typename Scalar>
  void BackSubstitute(const Numbers<Scalar>& numbers, const Eigen::VectorXd& y,
                      Eigen::VectorXd* x) const;
  template <typename Scalar>
  void EliminateColumns(const Numbers<Scalar>& numbers, const std::vector<NodeColumn>& B,
                        EliminatedColumns* Y) const;
  template <typename Scalar>
  void EliminateColumns(const Numbers<Scalar>& numbers, Eigen::Index begin, Eigen::Index end,
                        MatrixMemory<Scalar>* updates, const EliminatedColumns& Y,
                        std::vector<Scalar>* values) const;

  Crew* crew_{nullptr};
  Eigen::Index size_{0};           // scalars
  Eigen::Index largest_front_{0};  // rows, scalars
  EliminationOrder elimination_;
  std::vector<int> piece_of_;  // by node
  int num_pieces_{0};
  std::vector<Supernode> supernodes_;
  std::vector<int> supernode_of_;  // by position
  EliminationBranches branches_;   // of supernodes, for the crew: where they are factorised,
  EliminationBranches in_solves_;  // and in solves
  Eigen::Index num_rows_{0};       // of all fronts, scalars
  std::vector<Entry> entries_;     // by supernode
  std::size_t factor_size_{0};
  std::array<std::size_t, 2> update_sizes_{};
  std::variant<Numbers<double>, Numbers<float>> numbers_;
  mutable std::vector<int> block_of_;  // of the columns at hand, by supernode; -1: not reached
};

}  // namespace vacuum_gripper_sim
