#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "vacuum_gripper_sim/core/node_matrix.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"
#include "vacuum_gripper_sim/core/step_matrix.h"

namespace vacuum_gripper_sim {

/** Assembles and factorises on a second thread, one matrix at a time, as the asynchronous
 preconditioner that [Bernardin, Sec. III-A] takes from its reference [16].

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

  /// Copies what A is made of and starts. @pre status() is kIdle.
  void Start(const Linearization& linearization);
  /// Ends a factorisation. @pre status() is kDone. @returns it, the caller's until the next
  /// Start(), its factor to be exchanged at will; nothing if A was not positive definite.
  /// @throws what the other thread did.
  SparseCholesky* Finish();

 private:
  void Run();

  const StepMatrix* matrix_;
  Precision precision_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Status status_{Status::kIdle};  // guarded by mutex_, as is stop_
  bool stop_{false};
  // Of the worker while busy, else of the caller.
  Linearization linearization_;
  NodeMatrix A_;
  SparseCholesky factorization_;
  bool positive_definite_{false};
  std::exception_ptr error_;

  std::thread worker_;
};

}  // namespace vacuum_gripper_sim
