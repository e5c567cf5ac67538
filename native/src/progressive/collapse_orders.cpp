#include "progressive/collapse_orders.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace holomorph::progressive {
namespace {

// Larger stars wait: their vertex becomes a neighbour of many others, and they are slow to walk around.
constexpr int kLargestStar = 12;
// A round that removes less than this part of the vertices is not worth another one with the same rules.
constexpr double kLeastRemoved = 0.05;

class IndependentOrder {
 public:
  explicit IndependentOrder(EdgeCollapse& mesh) : mesh_(mesh) {
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      if ((mesh.vertex(v).flags & Vertex::kRemoved) == 0) left_.push_back(v);
    }
  }

  /// One round; returns how many vertices were removed. Vertices that are left are in ascending order.
  std::size_t round(Geometry geometry) {
    for (const int v : left_) mesh_.vertex(v).flags &= ~Vertex::kTouched;
    for (std::size_t k = 0; k < left_.size(); ++k) {
      const int v = left_[k];
      if ((mesh_.vertex(v).flags & Vertex::kTouched) == 0) visit(v, geometry);
    }
    const std::size_t before = left_.size();
    std::erase_if(left_, [this](int v) { return (mesh_.vertex(v).flags & Vertex::kRemoved) != 0; });
    return before - left_.size();
  }

  std::size_t left() const { return left_.size(); }

 private:
  void visit(int v, Geometry geometry) {
    if ((mesh_.vertex(v).flags & Vertex::kKept) != 0) return;
    mesh_.gather(v);
    const int n = mesh_.neighbour_count();
    if (geometry == Geometry::checked && n > kLargestStar) return;
    if (n > static_cast<int>(costs_.size())) costs_.resize(2 * n);
    constexpr float kRefused = std::numeric_limits<float>::infinity();
    for (int i = 0; i < n; ++i) costs_[i] = mesh_.along_boundary(i) ? mesh_.squared_length(i) : kRefused;
    while (true) {
      const auto best = std::min_element(costs_.begin(), costs_.begin() + n);
      if (*best == kRefused) return;
      if (collapse(static_cast<int>(best - costs_.begin()), geometry)) return;
      *best = kRefused;
    }
  }

  bool collapse(int i, Geometry geometry) {
    if (!mesh_.keeps_topology(i) || (geometry == Geometry::checked && !mesh_.keeps_normals(i))) return false;
    mesh_.collapse(i);
    // The neighbours wait for the next round, so that vertices removed in one round are not adjacent.
    for (int k = 0; k < mesh_.neighbour_count(); ++k) mesh_.vertex(mesh_.neighbour(k)).flags |= Vertex::kTouched;
    return true;
  }

  EdgeCollapse& mesh_;
  std::vector<int> left_;
  std::vector<float> costs_ = std::vector<float>(64);
};

// A priority queue of vertices, each at most once in it: lists in buckets of nearly equal cost, linked through the
// vertices themselves. Pops by ascending bucket, the last pushed first.

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

constexpr std::size_t kReportEvery = 256;  // batches
constexpr float kRefused = std::numeric_limits<float>::infinity();

class QuadricOrder {
 public:
  QuadricOrder(EdgeCollapse& mesh, Execution& execution) : mesh_(mesh), progress_(execution), queue_(mesh) {}

  void run(Geometry geometry) {
    geometry_ = geometry;
    // All begin in the lowest bucket: their costs are found when they are first visited.
    for (int v = mesh_.vertex_count() - 1; v >= 0; --v) {
      if ((mesh_.vertex(v).flags & Vertex::kRemoved) == 0) queue_.push(v, 0);
    }
    std::array<int, BucketQueue::kBatch> batch;
    for (int count = queue_.pop(batch); count > 0; count = queue_.pop(batch)) {
      if (++batches_ % kReportEvery == 0) progress_.report(mesh_.removed_fraction());
      mesh_.prefetch_stars(batch.data(), count);
      for (int i = 0; i < count; ++i) {
        queue_.visiting(batch[i]);
        visit(batch[i]);
      }
    }
  }

 private:
  // Collapses v, pushes it again, or leaves it out of the queue until its star changes.
  void visit(int v) {
    if ((mesh_.vertex(v).flags & Vertex::kKept) != 0) return;
    mesh_.gather(v);
    const int n = mesh_.neighbour_count();
    if (n > static_cast<int>(costs_.size())) costs_.resize(2 * n);
    for (int i = 0; i < n; ++i) costs_[i] = mesh_.along_boundary(i) ? mesh_.quadric_error(i) : kRefused;
    while (true) {
      int best = 0;
      for (int i = 1; i < n; ++i) best = costs_[i] < costs_[best] ? i : best;
      if (costs_[best] == kRefused) return;
      const int bucket = BucketQueue::bucket(costs_[best]);
      // The cost has grown since: the vertex goes back to the queue.
      if (bucket > queue_.current()) return queue_.push(v, bucket);
      if (mesh_.keeps_topology(best) && (geometry_ == Geometry::ignored || mesh_.keeps_normals(best)))
        return collapse(best);
      costs_[best] = kRefused;
    }
  }

  void collapse(int best) {
    mesh_.add_quadrics(best);
    mesh_.collapse(best);
    for (int i = 0; i < mesh_.neighbour_count(); ++i) {
      const int u = mesh_.neighbour(i);
      // The collapse may have lowered the cost of a neighbour, or allowed what was refused. Those in the queue are
      // looked at anyway.
      if (mesh_.vertex(u).next == Vertex::kNowhere) queue_.push(u, 0);
    }
  }

  EdgeCollapse& mesh_;
  Execution& progress_;
  BucketQueue queue_;
  Geometry geometry_ = Geometry::checked;
  std::size_t batches_ = 0;
  std::vector<float> costs_ = std::vector<float>(64);
};

}  // namespace

void collapse_independent_sets(EdgeCollapse& mesh, Execution& execution) {
  mesh.reserve(mesh.vertex_count());
  IndependentOrder order(mesh);
  while (static_cast<double>(order.round(Geometry::checked)) > kLeastRemoved * static_cast<double>(order.left())) {
    execution.report(mesh.removed_fraction());
  }
  // Then without regard to normals and sizes of stars, until no collapse is left.
  while (order.round(Geometry::ignored) > 0) {
  }
}

void collapse_by_quadrics(EdgeCollapse& mesh, Execution& execution) {
  mesh.compute_quadrics();
  mesh.reserve(mesh.vertex_count());
  QuadricOrder order(mesh, execution);
  order.run(Geometry::checked);
  // A refused vertex is tried again when its own star changes, not when a neighbour's does: so it is repeated until no
  // collapse is left. It ends, because each round but the last makes a collapse.
  for (std::size_t before = 0; before != mesh.collapses().size() || before == 0;) {
    before = mesh.collapses().size();
    order.run(Geometry::ignored);
    if (before == 0 && mesh.collapses().empty()) return;
  }
}

}  // namespace holomorph::progressive
