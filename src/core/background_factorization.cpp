#include "vacuum_gripper_sim/core/background_factorization.h"

#include <cstddef>
#include <utility>

namespace vacuum_gripper_sim {

BackgroundFactorization::BackgroundFactorization(const SparseCholesky& analyzed,
                                                 const StepMatrix& matrix, Precision precision)
    : matrix_(&matrix), precision_(precision), A_(matrix.pattern()) {
  product_.factorization = analyzed;
  product_.factorization.WorkAlone();
  product_.W.resize(static_cast<std::size_t>(analyzed.num_pieces()));
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

void BackgroundFactorization::Start(const Linearization& linearization,
                                    const std::vector<std::vector<NodeColumn>>& columns, double h) {
  linearization_ = linearization;
  columns_ = columns;
  h_ = h;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_ = Status::kBusy;
  }
  changed_.notify_one();
}

BackgroundFactorization::Product* BackgroundFactorization::Finish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_ = Status::kIdle;
  }
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  return positive_definite_ ? &product_ : nullptr;
}

void BackgroundFactorization::Make() {
  matrix_->Assemble(linearization_, &A_);
  positive_definite_ = product_.factorization.Factorize(A_, precision_);
  if (!positive_definite_) return;
  for (std::size_t piece = 0; piece < product_.W.size(); ++piece) {
    product_.W[piece].Reset(product_.factorization, h_);
    product_.W[piece].SetRows(columns_[piece]);
  }
}

void BackgroundFactorization::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || status_ == Status::kBusy; });
    if (stop_) return;
    lock.unlock();
    try {
      Make();
    } catch (...) {
      error_ = std::current_exception();
    }
    lock.lock();
    status_ = Status::kDone;
  }
}

}  // namespace vacuum_gripper_sim
