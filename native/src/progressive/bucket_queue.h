// A priority queue of vertices, each in it at most once: lists in buckets of nearly equal cost, linked through the
// vertices themselves. What is in it is popped by ascending bucket, the last pushed first.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "progressive/edge_collapse.h"

namespace holomorph::progressive {

class BucketQueue {
 public:
  explicit BucketQueue(EdgeCollapse& mesh) : mesh_(mesh), first_(kBuckets, kEnd) {}

  /// Eight buckets to an octave: the leading bits of the number, whose order is that of the numbers. @pre cost >= 0
  static int bucket(float cost) { return static_cast<int>(std::bit_cast<std::uint32_t>(cost) >> kShift); }

  /// Never pushes below the bucket that is being popped, so that popping goes forward only.
  void push(int v, int bucket) {
    if (bucket < current_) bucket = current_;
    mesh_.vertex(v).next = first_[bucket];
    first_[bucket] = v;
  }

  /// The next vertex, or -1 at the end, after which popping begins again at bucket 0.
  int pop() {
    while (first_[current_] == kEnd) {
      if (++current_ == kBuckets) return current_ = 0, -1;
    }
    const int v = first_[current_];
    int& next = mesh_.vertex(v).next;
    first_[current_] = next;
    next = Vertex::kNowhere;
    return v;
  }

  int current() const { return current_; }
  /// The vertex that comes after v in the bucket being popped, or -1.
  int first() const { return first_[current_]; }

 private:
  static constexpr int kShift = 20, kBuckets = 1 << (31 - kShift), kEnd = -1;
  EdgeCollapse& mesh_;
  std::vector<int> first_;
  int current_ = 0;
};

}  // namespace holomorph::progressive
