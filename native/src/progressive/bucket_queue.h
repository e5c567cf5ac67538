// A priority queue of vertices, each at most once in it: lists in buckets of nearly equal cost, linked through the
// vertices themselves. Pops by ascending bucket, the last pushed first.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "progressive/edge_collapse.h"

namespace holomorph::progressive {

class BucketQueue {
 public:
  static constexpr int kBatch = 8;

  explicit BucketQueue(EdgeCollapse& mesh) : mesh_(mesh), first_(kBuckets, kEnd) {}

  /// Eight buckets to an octave: the leading bits of the number, whose order is that of the numbers. @pre cost >= 0
  static int bucket(float cost) { return static_cast<int>(std::bit_cast<std::uint32_t>(cost) >> kShift); }

  /// Never pushes below the bucket that is being popped, so that popping is monotone.
  void push(int v, int bucket) {
    if (bucket < current_) bucket = current_;
    mesh_.vertex(v).next = first_[bucket];
    first_[bucket] = v;
  }

  /// Takes out up to kBatch vertices of the lowest bucket, so that their memory can be prefetched together. They wait:
  /// they are not pushed until `visiting` is called for them. 0 at the end, after which popping begins again at bucket
  /// 0.
  int pop(std::array<int, kBatch>& batch) {
    while (first_[current_] == kEnd) {
      if (++current_ == kBuckets) return current_ = 0;
    }
    int count = 0;
    for (int v = first_[current_]; v != kEnd && count < kBatch; v = first_[current_]) {
      first_[current_] = std::exchange(mesh_.vertex(v).next, Vertex::kWaiting);
      batch[count++] = v;
    }
    return count;
  }
  void visiting(int v) { mesh_.vertex(v).next = Vertex::kNowhere; }

  int current() const { return current_; }

 private:
  static constexpr int kShift = 20, kBuckets = 1 << (31 - kShift), kEnd = -1;
  EdgeCollapse& mesh_;
  std::vector<int> first_;
  int current_ = 0;
};

}  // namespace holomorph::progressive
