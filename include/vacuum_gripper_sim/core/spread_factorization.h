#pragma once

#include <Eigen/SparseCore>
#include <cstddef>

#include "vacuum_gripper_sim/core/pending_factorization.h"
#include "vacuum_gripper_sim/core/sparse_cholesky.h"
#include "vacuum_gripper_sim/core/step_matrix.h"

namespace vacuum_gripper_sim {

/// Factorises in equal portions, one a step, so that no step has to wait for all of it.
class SpreadFactorization : public PendingFactorization {
 public:
  /// @param analyzed Gives the structure of all matrices to come. @param matrix Assembles them;
  /// must outlive this. @param num_portions Calls of Advance() that a factorisation takes. >= 1
  SpreadFactorization(const SparseCholesky& analyzed, const StepMatrix& matrix, Precision precision,
                      int num_portions);

  Status status() const override { return status_; }
  void Start(const Linearization& linearization) override;
  void Advance() override;
  void Abandon() override { status_ = Status::kIdle; }
  SparseCholesky* Finish() override;

 private:
  const StepMatrix* matrix_;
  Precision precision_;
  int num_portions_;

  Status status_{Status::kIdle};
  int portion_{0};          // that are done
  std::size_t element_{0};  // that are assembled
  Linearization linearization_;
  Eigen::SparseMatrix<double> A_;
  SparseCholesky factorization_;
  bool positive_definite_{false};
};

}  // namespace vacuum_gripper_sim
