#include "mesh/surface.h"

#include <algorithm>
#include <utility>

#include "base/workers.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {

PolygonParts::PolygonParts(const Polygons& whole) : whole_(whole) {
  int count = static_cast<int>(whole.vertices.size());
  for (const int v : whole.corner_vertices) count = std::max(count, v + 1);
  new_vertex_.assign(count, -1);
}

PolygonPart PolygonParts::take(std::vector<int> faces) {
  PolygonPart part;
  part.face_index = std::move(faces);
  for (const int f : part.face_index) {
    for (int c = whole_.face_offsets[f]; c < whole_.face_offsets[f + 1]; ++c) {
      part.corner_index.push_back(c);
      const int v = whole_.corner_vertices[c];
      if (std::exchange(new_vertex_[v], 0) < 0) part.vertex_index.push_back(v);
    }
  }
  std::sort(part.vertex_index.begin(), part.vertex_index.end());
  for (std::size_t v = 0; v < part.vertex_index.size(); ++v) new_vertex_[part.vertex_index[v]] = static_cast<int>(v);

  Polygons& polygons = part.polygons;
  if (!whole_.vertices.empty()) {
    for (const int v : part.vertex_index) polygons.vertices.push_back(whole_.vertices[v]);
  }
  for (const int c : part.corner_index) polygons.corner_vertices.push_back(new_vertex_[whole_.corner_vertices[c]]);
  polygons.face_offsets.push_back(0);
  for (const int f : part.face_index) {
    const int size = whole_.face_offsets[f + 1] - whole_.face_offsets[f];
    polygons.face_offsets.push_back(polygons.face_offsets.back() + size);
  }
  for (const int v : part.vertex_index) new_vertex_[v] = -1;
  return part;
}

double area(const Surface& surface, Workers& workers) {
  return sum_over_rows(workers, static_cast<int>(surface.triangles.size()), 0.0, [&surface](int t, double& sum) {
    const auto& [a, b, c] = surface.triangle_edges[t];
    const auto& l = surface.edge_lengths;
    sum += triangle_area(l[a], l[b], l[c]);
  });
}

std::vector<double> vertex_areas(const Surface& surface, std::span<const double> lengths) {
  std::vector<double> areas(surface.vertex_count, 0.0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangle_edges[t];
    const double area = triangle_area(lengths[a], lengths[b], lengths[c]);
    for (const int v : surface.triangles[t]) areas[v] += area / 3;
  }
  return areas;
}

std::vector<Pair> edge_sides(const Surface& surface) {
  std::vector<Pair> sides(surface.edges.size(), Pair{-1, -1});
  for (int t = 0; t < std::ssize(surface.triangles); ++t) {
    for (int i = 0; i < 3; ++i) {
      Pair& own = sides[surface.triangle_edges[t][i]];
      own[own[0] < 0 ? 0 : 1] = 3 * t + i;
    }
  }
  return sides;
}

std::vector<Pair> edge_faces(const Surface& surface) {
  std::vector<Pair> faces = edge_sides(surface);
  for (Pair& own : faces) {
    for (int& side : own) side = side < 0 ? -1 : surface.triangle_faces[side / 3];
  }
  return faces;
}

int edge_between(std::span<const Pair> edges, int a, int b) {
  const Pair ends{std::min(a, b), std::max(a, b)};
  const auto found = std::lower_bound(edges.begin(), edges.end(), ends);
  return found != edges.end() && *found == ends ? static_cast<int>(found - edges.begin()) : -1;
}

}  // namespace holomorph::mesh
