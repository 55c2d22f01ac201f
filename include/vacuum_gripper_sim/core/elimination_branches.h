#pragma once

#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/crew.h"

namespace vacuum_gripper_sim {

/** A forest of fronts in postorder, cut into branches for several threads: whole subtrees, and
 single fronts above them. Branches that are not above each other have nothing in common. */
struct EliminationBranches {
  /// Fronts begin <= s < end.
  struct Branch {
    std::size_t begin{0}, end{0};
  };
  std::vector<Branch> branches;  ///< In postorder, too.
  Crew::Forest forest;           ///< Of the branches; leaves begin with the costliest, and
                                 ///< downwards they come last.
};

/** Cuts where the threads will be done first: the costliest subtree into its topmost front and what
 is below it, again and again, of which the best is kept ([Geist 1989]).
 @param parent Of each front; -1: none. @param cost Of each front, any unit. @param num_threads >=
 1; one gets everything as one branch.

 [Geist 1989] G. A. Geist, E. Ng, "Task scheduling for parallel sparse Cholesky factorization",
 Int. J. Parallel Program. 18(4). */
EliminationBranches CutIntoBranches(const std::vector<int>& parent, const std::vector<double>& cost,
                                    int num_threads);

/// How long the branches' work takes, in units of cost, if threads take it as those of a Crew do.
double Makespan(const EliminationBranches& branches, const std::vector<double>& cost,
                int num_threads);

}  // namespace vacuum_gripper_sim
