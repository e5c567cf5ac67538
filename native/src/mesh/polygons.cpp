#include "mesh/polygons.h"

#include <algorithm>
#include <utility>

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

}  // namespace holomorph::mesh
