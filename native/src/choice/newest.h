// The results that were made last, by what they were made of.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace holomorph::choice {

/// The values that were kept last. A value that was dropped is made again.
template <class Key, class Value>
class Newest {
 public:
  explicit Newest(std::size_t count) : count_(count) {}

  std::optional<Value> get(const Key& key) const {
    const std::lock_guard lock(mutex_);
    for (const auto& [own, value] : kept_) {
      if (own == key) return value;
    }
    return {};
  }
  void keep(const Key& key, Value value) {
    const std::lock_guard lock(mutex_);
    std::erase_if(kept_, [&](const auto& each) { return each.first == key; });
    kept_.emplace_back(key, std::move(value));
    if (kept_.size() > count_) kept_.erase(kept_.begin());
  }
  std::optional<Value> any() const {
    const std::lock_guard lock(mutex_);
    return kept_.empty() ? std::nullopt : std::optional(kept_.front().second);
  }

 private:
  mutable std::mutex mutex_;
  std::size_t count_;
  std::vector<std::pair<Key, Value>> kept_;  // the oldest first
};

}  // namespace holomorph::choice
