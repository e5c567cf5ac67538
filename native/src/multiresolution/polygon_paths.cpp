#include "multiresolution/polygon_paths.h"

#include <algorithm>
#include <span>

namespace holomorph::multiresolution {
namespace {

using mesh::HalfedgeHandle;
using mesh::Surface;

// #E the polygon of each diagonal that was flipped, -1 for all other edges.
std::vector<int> flipped_polygons(const Surface& surface, const Surface& flipped) {
  std::vector<int> polygon(surface.edges.size(), -1);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const int e : surface.triangle_edges[t]) {
      if (surface.edges[e] != flipped.edges[e]) polygon[e] = surface.triangle_faces[t];
    }
  }
  return polygon;
}

// The half-edge from a to b. @pre there is one
HalfedgeHandle half_edge(const mesh::HalfEdges& half_edges, int a, int b) {
  HalfedgeHandle h = half_edges.halfedge_handle(mesh::VertexHandle(a));
  while (mesh::to_vertex(half_edges, h) != b) h = mesh::next(half_edges, mesh::opposite(h));
  return h;
}

// Vertices of a polygon from a to b, both included.
std::vector<int> path_along(const Surface& surface, int face, int a, int b) {
  const auto& [vertices, corners, offsets, file] = surface.polygons;
  const auto begin = corners.begin() + offsets[face], end = corners.begin() + offsets[face + 1];
  std::vector<int> path;
  for (auto c = std::find(begin, end, a); path.empty() || path.back() != b; c = c + 1 == end ? begin : c + 1) {
    path.push_back(static_cast<int>(*c));
  }
  return path;
}

}  // namespace

void values_of_diagonals(const Surface& surface, const Surface& flipped, topology::IntegerForms& forms) {
  const std::vector<int> polygon = flipped_polygons(surface, flipped);
  // Edges of polygons come first, in lexicographic order.
  const auto polygon_edges = std::span(surface.edges).first(static_cast<std::size_t>(surface.polygon_edge_count));
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (polygon[e] < 0) continue;
    const auto path = path_along(surface, polygon[e], surface.edges[e][0], surface.edges[e][1]);
    // By closedness: the polygon is a disk, so both ways around give the same sum.
    topology::IntegerForms::Row sum;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      sum = topology::add(sum, forms.rows[mesh::edge_between(polygon_edges, path[i], path[i + 1])],
                          path[i] < path[i + 1] ? 1 : -1);
    }
    forms.rows.set(e, std::move(sum));
  }
}

std::vector<std::vector<HalfedgeHandle>> loops_of_half_edges(const Surface& surface, const Surface& flipped,
                                                             const std::vector<std::vector<int>>& loops,
                                                             Execution& execution) {
  const std::vector<int> polygon = flipped_polygons(surface, flipped);
  const mesh::HalfEdges half_edges = mesh::half_edges(flipped, execution);
  std::vector<std::vector<HalfedgeHandle>> result;
  for (const auto& loop : loops) {
    result.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      const HalfedgeHandle h = half_edge(half_edges, a, b);
      const int face = polygon[mesh::edge_of(h)];
      const std::vector<int> path = face < 0 ? std::vector<int>{a, b} : path_along(surface, face, a, b);
      for (std::size_t k = 0; k + 1 < path.size(); ++k)
        result.back().push_back(half_edge(half_edges, path[k], path[k + 1]));
    }
  }
  return result;
}

}  // namespace holomorph::multiresolution
