// The value that was made last, for callers on several threads.
#pragma once

#include <memory>
#include <mutex>

namespace holomorph {

/// Saves making the same value twice in a row. No lock is held while one is made, so two callers may make the same.
template <class Key, class Value>
class LastMade {
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

}  // namespace holomorph
