// make_delaunay. Each face is in one region. One thread flips the edges between two faces of a region; they remain
// between these, because a flip keeps its six half-edges in the same two faces. Edges between regions follow when all
// regions are done. No result depends on which thread takes which region.
#include "mesh/delaunay.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/double_double.h"
#include "base/workers.h"
#include "mesh/metric_errors.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// An edge is flipped only where cot + cot is clearly negative, relative to the cotangents ...
constexpr double kDelaunayTolerance = 1e-9;
// ... and never more often than this, so that rounding among slivers cannot flip it back and forth for ever.
constexpr unsigned kMostFlipsOfAnEdge = 60;
// Rounding of the length between the apices of a quadrilateral that is laid out, in units of rounding. An abscissa x is
// (b^2 + (s - e)(s + e)) / 2 b: 1 of b^2 and 3 of the product, over 2 b; 1 of their sum and 1 of the quotient. A
// height: 5.5 of the area (Kahan's order) and 1 of the quotient. Sums and differences: 1; std::hypot: 2.
constexpr double kOfBase = 0.5 * kUnit, kOfSides = 1.5 * kUnit, kOfAbscissa = 2 * kUnit, kOfHeight = 6.5 * kUnit;
constexpr double kOfSum = kUnit, kOfLength = 2 * kUnit;
// Many regions share out the work, large ones (in edges, a power of 2) leave little between them.
constexpr unsigned kRegions = 16, kLeastRegion = 8192;
// Prefetch distance, in queue entries.
constexpr std::size_t kAhead = 8;

// Marks of each edge, in one byte.
class EdgeMarks {
 public:
  explicit EdgeMarks(std::size_t edges) : bits_(edges) {}

  void set(int e, bool between, bool queued) { bits_[e] = (between ? kBetween : 0U) | (queued ? kQueued : 0U); }
  bool is_between(int e) const { return (bits_[e] & kBetween) != 0; }
  /// @return whether it was not in a queue before
  bool enqueue(int e) {
    const bool was_queued = (bits_[e] & kQueued) != 0;
    bits_[e] |= kQueued;
    return !was_queued;
  }
  void dequeue(int e) { bits_[e] &= ~kQueued; }
  /// @return whether it may be flipped once more
  bool count_flip(int e) {
    if ((bits_[e] & kCount) >= kMostFlipsOfAnEdge) return false;
    ++bits_[e];
    return true;
  }

 private:
  static constexpr unsigned char kQueued = 0x80, kBetween = 0x40, kCount = 0x3f;
  Array<unsigned char> bits_;
};

// Whether the edge lies between two different faces, so that it can be flipped.
bool is_interior(const HalfEdges& half_edges, int e) {
  const FaceHandle fa = half_edges.face_handle(HalfedgeHandle(2 * e)),
                   fb = half_edges.face_handle(HalfedgeHandle(2 * e + 1));
  return fa.is_valid() && fb.is_valid() && fa != fb;
}

bool is_delaunay(const IntrinsicTriangulation& t, int e) {
  const double x = t.cotangents[2 * e], y = t.cotangents[2 * e + 1];
  return x + y >= -kDelaunayTolerance * (1 + std::abs(x) + std::abs(y));
}

// Flips the edges of one region, or in the end those between regions.
class Flipper {
 public:
  Flipper(IntrinsicTriangulation& t, EdgeMarks& marks, bool in_region)
      : t_(t), mesh_(t.half_edges), marks_(marks), in_region_(in_region) {}

  std::vector<int> stack;    // edges to check, queued
  std::vector<int> between;  // edges to check when the regions are done
  std::vector<Flip> flips;
  std::size_t steps = 0;  // edges that were checked

  template <class Report>
  void run(const Report& report) {
    for (; !stack.empty(); ++steps) {
      if (steps % 4096 == 0) report(stack.size());
      const int e = stack.back();
      stack.pop_back();
      if (stack.size() > kAhead) look_ahead(stack[stack.size() - kAhead]);
      marks_.dequeue(e);
      if (is_interior(mesh_, e) && !is_delaunay(t_, e) && marks_.count_flip(e)) flip(e);
    }
  }

 private:
  void look_ahead(int e) const {
    mesh_.prefetch_halfedges(EdgeHandle(e));
    prefetch(&t_.cotangents[2 * e]);
    prefetch(&t_.lengths[e]);
  }

  double length(HalfedgeHandle h) const { return t_.lengths[edge_of(h)]; }

  // Length between the apices when both triangles are laid out in the plane with the edge on the x axis.
  RoundedLength new_length(HalfedgeHandle a, HalfedgeHandle b) const {
    const double base = length(a);
    struct Apex {                  // seen from the start of a half-edge
      double x, height, rounding;  // the rounding is that of x
    };
    const auto apex = [&](HalfedgeHandle h) {
      const HalfedgeHandle h1 = next(mesh_, h), h2 = next(mesh_, h1);
      const double from_end = length(h1), from_start = length(h2);
      const double x = (base * base + (from_start - from_end) * (from_start + from_end)) / (2 * base);
      const bool flat = from_start + from_end - base < kFlatMargin * base;
      return Apex{x, flat ? 0.0 : 2 * triangle_area(base, from_end, from_start) / base,
                  kOfBase * base + kOfSides * std::abs(2 * x - base) + kOfAbscissa * std::abs(x)};
    };
    const Apex p = apex(a), q = apex(b);
    const double from_p = base - q.x, across = p.x - from_p, up = p.height + q.height, length = std::hypot(across, up);
    const double of_across = p.rounding + q.rounding + kOfSum * (std::abs(from_p) + std::abs(across)),
                 of_up = (kOfHeight + kOfSum) * up;
    // A length is a convex function of the legs, and its square one of degree 2.
    const double first = std::abs(across) * of_across + up * of_up, second = of_across * of_across + of_up * of_up;
    const double rounding = length > 0 ? (first + second / 2) / length + kOfLength * length : of_across + of_up;
    return {length, rounding};  // energy_growth covers the rounding of this
  }

  void flip(int e) {
    const HalfedgeHandle a(2 * e), b(2 * e + 1);
    const bool has_errors = !t_.metric_errors.empty();
    const auto before = has_errors ? faces_beside(t_.metric(), a) : FacesBeside();
    const auto [flipped_length, rounding] = new_length(a, b);
    const HalfedgeHandle a1 = next(mesh_, a), a2 = next(mesh_, a1), b1 = next(mesh_, b), b2 = next(mesh_, b1);
    flip_links(mesh_, EdgeHandle(e));
    t_.lengths[e] = flipped_length;
    set_cotangents(t_, a);
    set_cotangents(t_, b);
    if (has_errors) {
      const auto [error_a, error_b] = errors_after_flip(t_.metric(), a, before, rounding);
      t_.metric_errors[mesh_.face_handle(a).idx()] = error_a;
      t_.metric_errors[mesh_.face_handle(b).idx()] = error_b;
    }
    flips.push_back({e, a2, b1});
    for (const HalfedgeHandle h : {a1, a2, b1, b2}) {
      const int rim = edge_of(h);
      if (in_region_ && marks_.is_between(rim)) {
        between.push_back(rim);
      } else if (marks_.enqueue(rim)) {
        stack.push_back(rim);
      }
    }
  }

  IntrinsicTriangulation& t_;
  HalfEdges& mesh_;
  EdgeMarks& marks_;
  bool in_region_;
};

// The edges that are not Delaunay, lowest on top of each stack.
struct Work {
  std::vector<Flipper> regions;
  Flipper rest;
};

// A face is in the region of its edge of lowest number: edges with near numbers have near vertices.
Work find_work(IntrinsicTriangulation& t, EdgeMarks& marks, Workers& workers) {
  const HalfEdges& half_edges = t.half_edges;
  const int edge_count = static_cast<int>(half_edges.n_edges());
  const int region_bits = std::bit_width(std::max(kLeastRegion, (edge_count + kRegions - 1) / kRegions) - 1);
  const auto region = [&](HalfedgeHandle h) {
    const HalfedgeHandle after = next(half_edges, h);
    return std::min({edge_of(h), edge_of(after), edge_of(next(half_edges, after))}) >> region_bits;
  };
  struct Bad {
    int edge, region;
  };
  std::vector<std::vector<Bad>> bad(chunk_count(edge_count));
  run_throwing(workers, chunk_count(edge_count), [&](int chunk) {
    for (int e = chunk * kChunk, end = std::min(e + kChunk, edge_count); e < end; ++e) {
      const bool interior = is_interior(half_edges, e), is_bad = interior && !is_delaunay(t, e);
      const int a = interior ? region(HalfedgeHandle(2 * e)) : 0, b = interior ? region(HalfedgeHandle(2 * e + 1)) : 0;
      marks.set(e, a != b, is_bad);
      if (is_bad) bad[chunk].push_back({e, a});
    }
  });
  Work result{std::vector<Flipper>(kRegions, Flipper(t, marks, true)), Flipper(t, marks, false)};
  for (auto list = bad.rbegin(); list != bad.rend(); ++list) {
    for (auto e = list->rbegin(); e != list->rend(); ++e) {
      Flipper& flipper = marks.is_between(e->edge) ? result.rest : result.regions[e->region];
      flipper.stack.push_back(e->edge);
    }
  }
  return result;
}

// Appends the flips in the order of the flippers.
void append_flips(const std::vector<Flipper>& flippers, std::vector<Flip>& flips) {
  std::size_t count = flips.size();
  for (const Flipper& flipper : flippers) count += flipper.flips.size();
  flips.reserve(count);
  advise_large_pages(flips.data(), count * sizeof(Flip));
  for (const Flipper& flipper : flippers) flips.insert(flips.end(), flipper.flips.begin(), flipper.flips.end());
}

void flip_all(IntrinsicTriangulation& t, Execution& execution) {
  Workers& workers = execution.workers();
  EdgeMarks marks(t.half_edges.n_edges());
  auto [regions, rest] = find_work(t, marks, workers);
  execution.report(0.2);
  run_throwing(workers, kRegions, [&regions = regions](int i) { regions[i].run([](std::size_t) {}); });
  execution.report(0.7);
  for (const Flipper& region : regions) {
    for (const int e : region.between) {
      if (marks.enqueue(e)) rest.stack.push_back(e);
    }
  }
  const double total = std::max(1.0, static_cast<double>(rest.stack.size()));
  rest.run([&](std::size_t left) { execution.report(std::max(0.7, 1.0 - 0.3 * static_cast<double>(left) / total)); });
  regions.push_back(std::move(rest));
  for (const Flipper& region : regions) Execution::count(region.steps);
  append_flips(regions, t.flips);
}

}  // namespace

void make_delaunay(IntrinsicTriangulation& t, Execution& execution) {
  if (!t.degenerate) return flip_all(t, execution);
  mollify_needles(t, execution.workers());
  flip_all(t, execution);
  if (mollify(t, execution.workers())) flip_all(t, execution);
}

Discretisation discretised(IntrinsicTriangulation&& triangulation, Execution& execution) {
  Discretisation result;
  result.weights = cotangent_weights(triangulation, execution);
  result.errors = energy_errors(triangulation.metric(), result.weights, execution.workers());
  result.metric_error = largest_error(triangulation.metric());
  result.mollification = triangulation.mollification;
  result.half_edges = std::move(triangulation.half_edges);
  result.lengths = std::move(triangulation.lengths);
  result.flips = std::move(triangulation.flips);
  triangulation.forget_metric();
  return result;
}

Discretisation on_input(const Surface& surface, HalfEdges half_edges, Execution& execution) {
  return discretised(intrinsic_triangulation(surface, std::move(half_edges), execution.workers()), execution);
}

Discretisation on_input_with_errors(const Surface& surface, HalfEdges half_edges, Execution& execution) {
  auto triangulation = given_triangulation(surface, std::move(half_edges), execution.workers());
  if (triangulation.degenerate) mollify(triangulation, execution.workers());
  return discretised(std::move(triangulation), execution);
}

Discretisation on_delaunay(const Surface& surface, HalfEdges half_edges, Execution& execution) {
  auto triangulation = given_triangulation(surface, std::move(half_edges), execution.workers());
  make_delaunay(triangulation, execution);
  return discretised(std::move(triangulation), execution);
}

}  // namespace holomorph::mesh
