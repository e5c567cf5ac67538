#include "mesh/intrinsic_triangulation.h"

#include <algorithm>
#include <numeric>

#include "base/chunks.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// Slack that mollification leaves each triangle, relative to the mean length.
constexpr double kSlack = 1e-6;

bool has_degenerate_face(const IntrinsicTriangulation& t, HalfedgeHandle h) {
  const HalfedgeHandle h1 = next(t.half_edges, h), h2 = next(t.half_edges, h1);
  return is_degenerate(t.lengths[edge_of(h)], t.lengths[edge_of(h1)], t.lengths[edge_of(h2)]);
}

// All cotangents, in the order of the edges, which is that of the vertices: near each other in memory wherever
// neighbours are, in whatever order the faces come. @return whether a triangle is degenerate
bool set_all_cotangents(IntrinsicTriangulation& t, Workers& workers) {
  t.cotangents.resize(t.half_edges.n_halfedges());
  return sum_over_rows(workers, static_cast<int>(t.cotangents.size()), 0, [&t](int i, int& degenerate) {
           const HalfedgeHandle h(i);
           if (t.half_edges.is_boundary(h)) {
             t.cotangents[i] = 0;
           } else if (is_first_of_face(t.half_edges, h)) {
             set_cotangents(t, h);
             degenerate += has_degenerate_face(t, h);
           }
         }) > 0;
}

}  // namespace

// The increment with which (a + x) + (b + x) - (c + x) >= slack holds in every triangle.
double smallest_increment(const Surface& surface, Workers& workers) {
  const auto& l = surface.edge_lengths;
  const int triangles = static_cast<int>(surface.triangle_edges.size());
  const int first_degenerate = first_row(workers, triangles, [&](int t) {
    const auto& [i, j, k] = surface.triangle_edges[t];
    return is_degenerate(l[i], l[j], l[k]);
  });
  if (first_degenerate == triangles) return 0.0;
  const double mean = std::accumulate(l.begin(), l.end(), 0.0) / static_cast<double>(l.size());
  double increment = 0;
  for (const auto& [i, j, k] : surface.triangle_edges) {
    const double longest = std::max({l[i], l[j], l[k]});
    increment = std::max(increment, kSlack * mean + 2 * longest - (l[i] + l[j] + l[k]));
  }
  return increment;
}

void set_cotangents(IntrinsicTriangulation& t, HalfedgeHandle h) {
  const HalfedgeHandle h1 = next(t.half_edges, h), h2 = next(t.half_edges, h1);
  const double a = t.lengths[edge_of(h)], b = t.lengths[edge_of(h1)], c = t.lengths[edge_of(h2)];
  const double area = triangle_area(a, b, c);
  t.cotangents[h.idx()] = cotangent(a, b, c, area);
  t.cotangents[h1.idx()] = cotangent(b, c, a, area);
  t.cotangents[h2.idx()] = cotangent(c, a, b, area);
}

IntrinsicTriangulation intrinsic_triangulation(const Surface& surface, HalfEdges half_edges, Workers& workers) {
  IntrinsicTriangulation result;
  result.half_edges = std::move(half_edges);
  result.lengths.resize(surface.edge_lengths.size());
  for_rows(workers, static_cast<int>(result.lengths.size()),
           [&](int e) { result.lengths[e] = surface.edge_lengths[e]; });
  if (set_all_cotangents(result, workers)) {
    result.mollification = smallest_increment(surface, workers);
    for (double& l : result.lengths) l += result.mollification;
    set_all_cotangents(result, workers);
  }
  return result;
}

Array<double> cotangent_weights(const IntrinsicTriangulation& t, Execution& execution) {
  Array<double> weights;
  weights.reserve(t.lengths.size());
  advise_large_pages(weights.data(), t.lengths.size() * sizeof(double));
  weights.resize(t.lengths.size());
  for_rows(execution.workers(), static_cast<int>(weights.size()),
           [&](int e) { weights[e] = 0.5 * t.cotangents[2 * e] + 0.5 * t.cotangents[2 * e + 1]; });
  execution.report(1.0);
  return weights;
}

}  // namespace holomorph::mesh
