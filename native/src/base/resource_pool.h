// Costly values shared by callers on several threads: a memo of the last one, and a pool of one.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "base/execution.h"

namespace holomorph {

/// Saves making the same value twice in a row. No lock is held while one is made, so two callers may make the same.
template <class Key, class Value>
class Memo {
 public:
  /// The value of the key: the one made last, or make().
  template <class Make>
  std::shared_ptr<const Value> get(const Key& key, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      if (value_ && key_ == key) return value_;
    }
    std::shared_ptr<const Value> made = make();
    const std::lock_guard lock(mutex_);
    key_ = key;
    value_ = made;
    return made;
  }

 private:
  std::mutex mutex_;
  Key key_;
  std::shared_ptr<const Value> value_;
};

/// Returns the cached object, or a new one if it is in use. No caller waits, so a call from within the progress
/// function of another returns.
template <class T>
class ResourcePool {
 public:
  /// Makes one more. All that it makes compute the same bits.
  using Make = std::function<std::unique_ptr<T>(Execution&)>;

  explicit ResourcePool(Make make) : make_(std::move(make)) {}

  /// The object comes back when the last copy of the pointer is gone. @pre the pool outlives the pointer
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
