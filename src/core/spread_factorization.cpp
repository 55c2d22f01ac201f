#include "vacuum_gripper_sim/core/spread_factorization.h"

#include <algorithm>
#include <cmath>

namespace vacuum_gripper_sim {
namespace {

/// What assembling takes of a factorisation's time, about.
constexpr double kAssemblyShare = 0.3;

}  // namespace

SpreadFactorization::SpreadFactorization(const SparseCholesky& analyzed, const StepMatrix& matrix,
                                         Precision precision, int num_portions)
    : matrix_(&matrix),
      precision_(precision),
      num_portions_(num_portions),
      A_(matrix.pattern()),
      factorization_(analyzed) {}

void SpreadFactorization::Start(const Linearization& linearization) {
  linearization_ = linearization;
  portion_ = 0;
  element_ = 0;
  matrix_->SetMasses(linearization_, &A_);
  factorization_.Begin(precision_);
  status_ = Status::kBusy;
}

void SpreadFactorization::Advance() {
  if (status_ != Status::kBusy) return;
  ++portion_;
  const double done = static_cast<double>(portion_) / num_portions_;
  const std::size_t num_elements = matrix_->num_elements();
  const double assembled = std::min(1.0, done / kAssemblyShare);
  const auto end =
      static_cast<std::size_t>(std::ceil(assembled * static_cast<double>(num_elements)));
  matrix_->AddElements(linearization_, element_, end, &A_);
  element_ = end;
  if (element_ < num_elements) return;

  using Progress = SparseCholesky::Progress;
  const Progress progress =
      factorization_.ContinueTo((done - kAssemblyShare) / (1.0 - kAssemblyShare), A_);
  if (progress == Progress::kPart) return;
  positive_definite_ = progress == Progress::kDone;
  status_ = Status::kDone;
}

SparseCholesky* SpreadFactorization::Finish() {
  status_ = Status::kIdle;
  return positive_definite_ ? &factorization_ : nullptr;
}

}  // namespace vacuum_gripper_sim
