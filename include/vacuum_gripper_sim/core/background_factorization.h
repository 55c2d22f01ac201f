#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "vacuum_gripper_sim/core/delassus_operator.h"
#include "vacuum_gripper_sim/core/eliminated_columns.h"
#include "vacuum_gripper_sim/core/node_matrix.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"
#include "vacuum_gripper_sim/core/step_matrix.h"

namespace vacuum_gripper_sim {

/** Assembles and factorises on a second thread, one matrix at a time, as the asynchronous
 preconditioner that [Bernardin, Sec. III-A] takes from its reference [16]; and makes W of contacts
 that will most likely be there still when it is done.

 [16] H. Courtecuisse et al., "Asynchronous preconditioners for efficient solving of non-linear
   deformations", VRIPHYS 2010. */
class BackgroundFactorization {
 public:
  /// @param analyzed Gives the structure of all matrices to come. @param matrix Assembles them;
  /// must outlive this.
  BackgroundFactorization(const SparseCholesky& analyzed, const StepMatrix& matrix,
                          Precision precision);
  /// Waits for a factorisation that is under way.
  ~BackgroundFactorization();
  BackgroundFactorization(const BackgroundFactorization&) = delete;
  BackgroundFactorization& operator=(const BackgroundFactorization&) = delete;

  enum class Status { kIdle, kBusy, kDone };
  Status status() const;

  /// What the second thread makes; the caller's from Finish() to the next Start(), to be exchanged
  /// at will.
  struct Product {
    SparseCholesky factorization;
    std::vector<DelassusOperator> W;  ///< Of the contacts' columns, by piece of A.
  };

  /// Copies what A is made of and starts. @param columns Of contacts, by piece of A, see
  /// ContactColumns. @param h Time step. [s] @pre status() is kIdle.
  void Start(const Linearization& linearization,
             const std::vector<std::vector<NodeColumn>>& columns, double h);
  /// Ends what was started. @pre status() is kDone. @returns nothing if A was not positive
  /// definite. @throws what the other thread did.
  Product* Finish();

 private:
  void Run();
  void Make();

  const StepMatrix* matrix_;
  Precision precision_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Status status_{Status::kIdle};  // guarded by mutex_, as is stop_
  bool stop_{false};
  // Of the worker while busy, else of the caller.
  Linearization linearization_;
  std::vector<std::vector<NodeColumn>> columns_;
  double h_{0.0};
  NodeMatrix A_;
  Product product_;
  bool positive_definite_{false};
  std::exception_ptr error_;

  std::thread worker_;
};

}  // namespace vacuum_gripper_sim
