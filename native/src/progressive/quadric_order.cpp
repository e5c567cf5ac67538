#include "progressive/quadric_order.h"

#include <limits>

#include "progressive/bucket_queue.h"

namespace holomorph::progressive {
namespace {

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
