// Something costly that one caller uses at a time, for callers on several threads.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "base/execution.h"

namespace holomorph {

/// Lends the one that it keeps or, while that is lent, another one made for the caller. So nobody waits, and a call
/// from within the progress function of another returns.
template <class T>
class Lender {
 public:
  /// Makes one more. All that it makes compute the same bits.
  using Make = std::function<std::unique_ptr<T>(Execution&)>;

  explicit Lender(Make make) : make_(std::move(make)) {}

  /// Lends one. It comes back when the last copy of the pointer is gone. @pre the lender outlives the pointer
  std::shared_ptr<T> borrow(Execution& execution) const {
    std::unique_ptr<T> lent;
    {
      const std::lock_guard lock(mutex_);
      lent = std::move(kept_);
    }
    if (!lent) lent = make_(execution);
    return {lent.release(), [this](T* back) { take_back(std::unique_ptr<T>(back)); }};
  }

 private:
  void take_back(std::unique_ptr<T> lent) const {
    const std::lock_guard lock(mutex_);
    if (!kept_) kept_ = std::move(lent);
  }

  Make make_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<T> kept_;
};

}  // namespace holomorph
