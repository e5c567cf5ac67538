// Costly values shared by callers on several threads: the newest ones by their keys, and a pool of one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/execution.h"

namespace holomorph {

/// The values that were asked for last, so many of them, by what they are made of. No lock is held while one is made,
/// so two callers may make the same.
template <class Key, class Value>
class Newest {
 public:
  explicit Newest(std::size_t count = 1) : count_(count) {}

  /// The value that is kept, or make().
  template <class Make>
  Value get(const Key& key, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      const auto known = std::ranges::find(kept_, key, &Kept::first);
      if (known != kept_.end()) {
        std::rotate(known, known + 1, kept_.end());
        return kept_.back().second;
      }
    }
    const Value made = make();
    keep(key, made);
    return made;
  }
  void keep(const Key& key, Value value) {
    const std::lock_guard lock(mutex_);
    std::erase_if(kept_, [&](const Kept& each) { return each.first == key; });
    kept_.emplace_back(key, std::move(value));
    if (kept_.size() > count_) kept_.erase(kept_.begin());
  }
  /// The one that was asked for before all others.
  std::optional<Value> any() const {
    const std::lock_guard lock(mutex_);
    return kept_.empty() ? std::nullopt : std::optional(kept_.front().second);
  }

 private:
  using Kept = std::pair<Key, Value>;

  mutable std::mutex mutex_;
  std::size_t count_;
  std::vector<Kept> kept_;  // the oldest first
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
