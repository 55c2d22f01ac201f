#pragma once

#include "vacuum_gripper_sim/core/sparse_cholesky.h"
#include "vacuum_gripper_sim/core/step_matrix.h"

namespace vacuum_gripper_sim {

/// Assembles and factorises one matrix at a time while steps go on with the factorisation before.
class PendingFactorization {
 public:
  enum class Status { kIdle, kBusy, kDone };

  PendingFactorization() = default;
  PendingFactorization(const PendingFactorization&) = delete;
  PendingFactorization& operator=(const PendingFactorization&) = delete;
  virtual ~PendingFactorization() = default;

  virtual Status status() const = 0;
  /// Copies what A is made of. @pre status() is kIdle.
  virtual void Start(const Linearization& linearization) = 0;
  /// Does what a step's thread has to contribute in each step.
  virtual void Advance() {}
  /// Gives up what is under way, if that spares the step's thread something.
  virtual void Abandon() {}
  /// Ends a factorisation. @pre status() is kDone. @returns it, the caller's until the next Start()
  /// and to be exchanged at will; nothing if A was not positive definite.
  /// @throws what another thread did.
  virtual SparseCholesky* Finish() = 0;
};

}  // namespace vacuum_gripper_sim
