#include "topology/domain.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "base/constants.h"

namespace holomorph::topology {
namespace {

using mesh::edge_of;
using mesh::next;
using mesh::opposite;
using mesh::to_vertex;
using mesh::VertexHandle;

// A priority queue for keys that never fall below the last one taken, such as the distances of Dijkstra's search.

// Only the keys of the current bucket are in a heap, which is small enough for the L1 cache; those of later
// buckets are unsorted. What is taken is the same as from one heap: the lowest key, at equal keys the lowest index.
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

constexpr int kReportEvery = 4096;
// Buckets of the queue per edge of mean length.
constexpr double kBucketsPerEdge = 8;

double mean(std::span<const double> lengths) {
  double sum = 0;
  for (const double length : lengths) sum += length;
  return sum / static_cast<double>(lengths.size());
}

class ShortestPathTree {
 public:
  ShortestPathTree(const mesh::Surface& surface, const HalfEdges& half_edges, const std::vector<mesh::Star>& stars,
                   FundamentalDomain& domain)
      : surface_(surface),
        mesh_(half_edges),
        stars_(stars),
        domain_(domain),
        queue_(mean(surface.edge_lengths) / kBucketsPerEdge) {
    const std::size_t n = half_edges.n_vertices();
    distance.assign(n, kInfinity);
    domain_.to_parent_vertex.assign(n, HalfedgeHandle());
    domain_.vertex_rank.resize(n);
    settled_.assign(n, 0);
    domain_.gaps.resize(domain_.boundary.loops.size());
    if (stars.empty()) return;
    star_of_.assign(n, -1);
    for (std::size_t s = 0; s < stars.size(); ++s) {
      star_of_[stars[s].vertex] = static_cast<int>(s);
      for (const HalfedgeHandle h : stars[s].link) star_of_[to_vertex(half_edges, h)] = static_cast<int>(s);
    }
  }

  void grow(int root, Execution& execution) {
    distance[root] = 0;
    queue_.push({0.0, root});
    while (!queue_.empty()) {
      const int v = queue_.pop().index;
      // An entry of a longer path, overtaken since it was pushed.
      if (settled_[v]) continue;
      settle(v);
      if (!star_of_.empty() && star_of_[v] >= 0) settle_star(v, stars_[star_of_[v]]);
      if (domain_.boundary.loop_of_vertex[v] >= 0) settle_loop(v);
      if (done_ % kReportEvery == 0)
        execution.report(0.7 * static_cast<double>(done_) / static_cast<double>(distance.size()));
    }
  }

  Array<double> distance;

 private:
  void settle(int v) {
    settled_[v] = 1;
    domain_.vertex_rank[v] = done_++;
    const HalfedgeHandle start = mesh_.halfedge_handle(VertexHandle(v));
    HalfedgeHandle h = start;
    do {
      const int w = to_vertex(mesh_, h), e = edge_of(h);
      if (!settled_[w] && !surface_.is_diagonal(e)) {
        const double through = distance[v] + surface_.edge_lengths[e];
        if (through < distance[w]) reach(w, through, opposite(h));
      }
      h = next(mesh_, opposite(h));
    } while (h != start);
  }

  void reach(int w, double at, HalfedgeHandle to_parent) {
    distance[w] = at;
    domain_.to_parent_vertex[w] = to_parent;
    queue_.push({at, w});
  }

  // T enters a star once, and has all its spokes: the centre is joined to the vertex that was reached first, the rest
  // of the link to the centre.
  void settle_star(int first, const mesh::Star& star) {
    for (const HalfedgeHandle h : star.link) {
      if (to_vertex(mesh_, h) == first) join(star.vertex, first, next(mesh_, h));
    }
    for (const HalfedgeHandle h : star.link) join(to_vertex(mesh_, h), first, next(mesh_, h));
  }

  // Settles v at no further distance. The half-edge `between` joins v and its parent, in either direction.
  void join(int v, int first, HalfedgeHandle between) {
    if (settled_[v]) return;
    distance[v] = distance[first];
    domain_.to_parent_vertex[v] = mesh::from_vertex(mesh_, between) == v ? between : opposite(between);
    settle(v);
  }

  // Joins the whole loop to v, both ways around. The edge opposite v is the gap e_k, which is not in T.
  void settle_loop(int v) {
    std::vector<HalfedgeHandle> loop;
    const HalfedgeHandle start = mesh_.halfedge_handle(VertexHandle(v));
    HalfedgeHandle h = start;
    do {
      loop.push_back(h);
      h = next(mesh_, h);
    } while (h != start);
    const std::size_t middle = loop.size() / 2;
    domain_.gaps[domain_.boundary.loop_of_vertex[v]] = loop[middle];
    for (std::size_t i = 0; i < middle; ++i) join(to_vertex(mesh_, loop[i]), v, loop[i]);
    for (std::size_t i = loop.size() - 1; i > middle; --i) join(mesh::from_vertex(mesh_, loop[i]), v, loop[i]);
  }

  const mesh::Surface& surface_;
  const HalfEdges& mesh_;
  const std::vector<mesh::Star>& stars_;
  FundamentalDomain& domain_;
  Array<int> star_of_;  // #V star that the vertex belongs to, or -1; empty without stars
  MonotoneQueue queue_;
  Array<char> settled_;  // #V bytes, which fit into the cache
  int done_ = 0;
};

}  // namespace

Array<double> grow_shortest_paths(const mesh::Surface& surface, const HalfEdges& half_edges,
                                  const std::vector<mesh::Star>& stars, int root, FundamentalDomain& domain,
                                  Execution& execution) {
  ShortestPathTree tree(surface, half_edges, stars, domain);
  tree.grow(root, execution);
  return std::move(tree.distance);
}

}  // namespace holomorph::topology
