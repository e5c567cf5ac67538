#include "mesh/intrinsic_triangulation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/chunks.h"
#include "base/page_allocator.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// The cotangent of the angle opposite each half-edge; those outside the surface are not set.
Array<double> opposite_cotangents(const IntrinsicTriangulation& t, Workers& workers) {
  Array<double> result(2 * t.lengths.size());
  for_rows(workers, static_cast<int>(t.half_edges.n_faces()), [&](int f) {
    const HalfedgeHandle h0 = t.half_edges.halfedge_handle(FaceHandle(f));
    const HalfedgeHandle h1 = next(t.half_edges, h0), h2 = next(t.half_edges, h1);
    const double a = t.lengths[edge_of(h0)], b = t.lengths[edge_of(h1)], c = t.lengths[edge_of(h2)];
    const double area = triangle_area(a, b, c);
    result[h0.idx()] = cotangent(a, b, c, area);
    result[h1.idx()] = cotangent(b, c, a, area);
    result[h2.idx()] = cotangent(c, a, b, area);
  });
  return result;
}

// Slack that mollification leaves each triangle, relative to the mean length.
constexpr double kSlack = 1e-6;
// An edge is turned only where cot + cot is clearly negative, relative to the cotangents ...
constexpr double kDelaunayTolerance = 1e-9;
// ... and never more often than this, so that rounding among slivers cannot turn it back and forth for ever.
constexpr int kMostFlipsOfAnEdge = 64;

class Flipper {
 public:
  explicit Flipper(IntrinsicTriangulation& t)
      : t_(t), mesh_(t.half_edges), queued_(t.lengths.size(), 0), flip_count_(t.lengths.size(), 0) {
    Workers workers;
    const Array<double> cotangents = opposite_cotangents(t, workers);
    for_rows(workers, static_cast<int>(t.lengths.size()),
             [&](int e) { queued_[e] = is_interior(e) && !is_delaunay(cotangents[2 * e], cotangents[2 * e + 1]); });
    for (int e = static_cast<int>(t.lengths.size()) - 1; e >= 0; --e) {  // lowest index first
      if (queued_[e] != 0) stack_.push_back(e);
    }
  }

  void run(Progress& progress) {
    const double total = std::max(1.0, static_cast<double>(stack_.size()));
    for (std::size_t steps = 0; !stack_.empty(); ++steps) {
      if (steps % 4096 == 0) progress.report(std::max(0.0, 1.0 - static_cast<double>(stack_.size()) / total));
      const int e = stack_.back();
      stack_.pop_back();
      queued_[e] = 0;
      const HalfedgeHandle a(2 * e), b(2 * e + 1);
      if (!is_interior(e) || is_delaunay(opposite_cotangent(a), opposite_cotangent(b))) continue;
      if (++flip_count_[e] > kMostFlipsOfAnEdge) continue;
      flip(e, a, b);
    }
  }

 private:
  double length(HalfedgeHandle h) const { return t_.lengths[edge_of(h)]; }

  double opposite_cotangent(HalfedgeHandle h) const {
    const HalfedgeHandle h1 = next(mesh_, h), h2 = next(mesh_, h1);
    const double a = length(h), b = length(h1), c = length(h2);
    return cotangent(a, b, c, triangle_area(a, b, c));
  }

  // Between two different faces.
  bool is_interior(int e) const {
    const FaceHandle fa = mesh_.face_handle(HalfedgeHandle(2 * e)), fb = mesh_.face_handle(HalfedgeHandle(2 * e + 1));
    return fa.is_valid() && fb.is_valid() && fa != fb;
  }

  // By the cotangents opposite the edge.
  static bool is_delaunay(double x, double y) { return x + y >= -kDelaunayTolerance * (1 + std::abs(x) + std::abs(y)); }

  // Length between the apices when both triangles are laid out in the plane with the edge on the x axis.
  double new_length(HalfedgeHandle a, HalfedgeHandle b) const {
    const double base = length(a);
    const auto apex = [&](HalfedgeHandle h) {  // seen from the start of h: abscissa, height
      const HalfedgeHandle h1 = next(mesh_, h), h2 = next(mesh_, h1);
      const double from_end = length(h1), from_start = length(h2);
      const double x = (base * base + (from_start - from_end) * (from_start + from_end)) / (2 * base);
      return std::array<double, 2>{x, 2 * triangle_area(base, from_end, from_start) / base};
    };
    const auto [xa, ya] = apex(a);
    const auto [xb, yb] = apex(b);
    return std::hypot(xa - (base - xb), ya + yb);
  }

  void flip(int e, HalfedgeHandle a, HalfedgeHandle b) {
    const double turned = new_length(a, b);
    const HalfedgeHandle a1 = next(mesh_, a), a2 = next(mesh_, a1), b1 = next(mesh_, b), b2 = next(mesh_, b1);
    flip_links(mesh_, EdgeHandle(e));
    t_.lengths[e] = turned;
    t_.flips.push_back({e, a2, b1});
    for (const HalfedgeHandle h : {a1, a2, b1, b2}) {
      if (!std::exchange(queued_[edge_of(h)], 1)) stack_.push_back(edge_of(h));
    }
  }

  IntrinsicTriangulation& t_;
  HalfEdges& mesh_;
  std::vector<char> queued_;
  std::vector<signed char> flip_count_;
  std::vector<int> stack_;
};

}  // namespace

// The increment with which (a + x) + (b + x) - (c + x) >= slack holds in every triangle.
double smallest_increment(const Surface& surface) {
  const auto& l = surface.edge_lengths;
  const double mean = std::accumulate(l.begin(), l.end(), 0.0) / static_cast<double>(l.size());
  double increment = 0;
  bool degenerate = false;
  for (const auto& [i, j, k] : surface.triangle_edges) {
    degenerate = degenerate || is_degenerate(l[i], l[j], l[k]);
    const double longest = std::max({l[i], l[j], l[k]});
    increment = std::max(increment, kSlack * mean + 2 * longest - (l[i] + l[j] + l[k]));
  }
  return degenerate ? increment : 0.0;
}

IntrinsicTriangulation intrinsic_triangulation(const Surface& surface, HalfEdges half_edges) {
  IntrinsicTriangulation result{std::move(half_edges), surface.edge_lengths, {}, smallest_increment(surface)};
  for (double& l : result.lengths) l += result.mollification;
  return result;
}

void make_delaunay(IntrinsicTriangulation& triangulation, Progress& progress) { Flipper(triangulation).run(progress); }

std::vector<double> cotangent_weights(const IntrinsicTriangulation& t, Progress& progress) {
  Workers workers;
  const Array<double> cotangents = opposite_cotangents(t, workers);
  progress.report(0.5);
  const auto half = [&](int h) { return t.half_edges.is_boundary(HalfedgeHandle(h)) ? 0.0 : 0.5 * cotangents[h]; };
  std::vector<double> weights(t.lengths.size());
  for_rows(workers, static_cast<int>(weights.size()), [&](int e) { weights[e] = half(2 * e) + half(2 * e + 1); });
  progress.report(1.0);
  return weights;
}

}  // namespace holomorph::mesh
