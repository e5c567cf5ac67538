// A priority queue for keys that never fall below the last one taken, such as the distances of Dijkstra's search.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace holomorph::topology {

/// Only the keys of the current bucket are in a heap, which is small enough for the L1 cache; those of later
/// buckets are unsorted. What is taken is the same as from one heap: the lowest key, at equal keys the lowest index.
class MonotoneQueue {
 public:
  struct Entry {
    double key;
    int index;
  };

  /// @param width of the buckets, in the unit of the keys. It suits where a bucket has a few keys, and the largest step
  /// spans a few buckets
  explicit MonotoneQueue(double width) : width_(width), buckets_(1) {}

  /// @pre key is not lower than the last one taken, and not negative
  void push(Entry entry) {
    const auto bucket = static_cast<std::size_t>(entry.key / width_);
    if (bucket <= current_) {
      heap_.push_back(entry);
      std::push_heap(heap_.begin(), heap_.end(), later);
    } else {
      if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
      buckets_[bucket].push_back(entry);
    }
    ++size_;
  }

  bool empty() const { return size_ == 0; }

  Entry pop() {
    while (heap_.empty()) {
      heap_ = std::move(buckets_[++current_]);  // its own memory becomes that of the next bucket
      std::make_heap(heap_.begin(), heap_.end(), later);
    }
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const Entry entry = heap_.back();
    heap_.pop_back();
    --size_;
    return entry;
  }

 private:
  static bool later(const Entry& a, const Entry& b) { return a.key != b.key ? a.key > b.key : a.index > b.index; }

  double width_;
  std::vector<Entry> heap_;                  // the current bucket
  std::vector<std::vector<Entry>> buckets_;  // the buckets after it
  std::size_t current_ = 0, size_ = 0;
};

}  // namespace holomorph::topology
