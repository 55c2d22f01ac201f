#include "vacuum_gripper_sim/core/background_factorization.h"

#include <utility>

namespace vacuum_gripper_sim {

BackgroundFactorization::BackgroundFactorization(const SparseCholesky& analyzed,
                                                 const StepMatrix& matrix, Precision precision)
    : matrix_(&matrix), precision_(precision), A_(matrix.pattern()), factorization_(analyzed) {
  factorization_.WorkAlone();
  worker_ = std::thread([this] { Run(); });
}

BackgroundFactorization::~BackgroundFactorization() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  worker_.join();
}

BackgroundFactorization::Status BackgroundFactorization::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void BackgroundFactorization::Start(const Linearization& linearization) {
  linearization_ = linearization;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_ = Status::kBusy;
  }
  changed_.notify_one();
}

SparseCholesky* BackgroundFactorization::Finish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_ = Status::kIdle;
  }
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  return positive_definite_ ? &factorization_ : nullptr;
}

void BackgroundFactorization::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || status_ == Status::kBusy; });
    if (stop_) return;
    lock.unlock();
    try {
      matrix_->Assemble(linearization_, &A_);
      positive_definite_ = factorization_.Factorize(A_, precision_);
    } catch (...) {
      error_ = std::current_exception();
    }
    lock.lock();
    status_ = Status::kDone;
  }
}

}  // namespace vacuum_gripper_sim
