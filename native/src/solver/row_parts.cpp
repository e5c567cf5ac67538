#include "solver/row_parts.h"

namespace holomorph::solver {

std::unique_ptr<RowPart> PartsInOrder::take() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return std::make_unique<RowPart>();
  auto part = std::move(free_.back());
  free_.pop_back();
  part->ends.clear();
  part->size = 0;
  return part;
}

void PartsInOrder::finish(int chunk, std::unique_ptr<RowPart> part) {
  std::unique_lock lock(mutex_);
  done_[chunk] = std::move(part);
  if (appending_) return;  // that thread will look again
  appending_ = true;
  while (next_ < done_.size() && done_[next_] && !failure_) {
    auto ready = std::move(done_[next_++]);
    lock.unlock();
    try {
      append(*ready);
    } catch (...) {
      fail(std::current_exception());
    }
    lock.lock();
    free_.push_back(std::move(ready));
  }
  appending_ = false;
}

void PartsInOrder::fail(std::exception_ptr failure) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::move(failure);
}

void PartsInOrder::append(const RowPart& part) {
  const auto before = static_cast<int>(result_.column.size());
  for (const int end : part.ends) result_.start.push_back(before + end);
  const auto used = static_cast<std::ptrdiff_t>(part.size);
  result_.column.insert(result_.column.end(), part.column.begin(), part.column.begin() + used);
  result_.weight.insert(result_.weight.end(), part.weight.begin(), part.weight.begin() + used);
}

}  // namespace holomorph::solver
