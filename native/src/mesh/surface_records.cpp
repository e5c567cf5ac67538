#include "mesh/surface_records.h"

#include <string>

#include "base/errors.h"
#include "mesh/half_edges.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

using std::to_string;

void record_isolated_vertices(Surface& surface) {
  std::vector<char> used(surface.vertex_count, 0);
  for (const auto v : surface.polygons.corner_vertices) used[v] = 1;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (!used[v]) surface.repairs.isolated_vertices.push_back(v);
  }
}

void record_zero_areas(Surface& surface) {
  auto& zero = surface.repairs.zero_area_faces;
  std::size_t count = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& e = surface.triangle_edges[t];
    const auto& l = surface.edge_lengths;
    if (!is_degenerate(l[e[0]], l[e[1]], l[e[2]])) continue;
    ++count;
    if (zero.empty() || zero.back() != surface.triangle_faces[t]) zero.push_back(surface.triangle_faces[t]);
  }
  if (count == surface.triangles.size()) throw InvalidMesh("all faces have zero area (face 0 is the first)");
}

void count_edge_faces(Surface& surface) {
  surface.edge_face_count.assign(surface.edges.size(), 0);
  for (const auto& sides : surface.triangle_edges) {
    for (const int e : sides) ++surface.edge_face_count[e];
  }
}

}  // namespace

void record_orientation(Surface& surface, const Orientation& orientation) {
  if (const int e = orientation.conflict; e >= 0) {
    const auto [a, b] = surface.edges[e];
    throw TopologyError("the surface is non-orientable: its faces cannot be turned to agree at edge " + to_string(e) +
                        " (vertices " + to_string(a) + ", " + to_string(b) + ")");
  }
  surface.face_component = orientation.face_component;
  surface.component_count = orientation.component_count;
  for (int f = 0; f < static_cast<int>(orientation.reversed.size()); ++f) {
    if (orientation.reversed[f]) surface.repairs.reversed_faces.push_back(f);
  }
}

void finish_records(Surface& surface) {
  count_edge_faces(surface);
  record_isolated_vertices(surface);
  record_zero_areas(surface);
  Progress silent;
  refuse_pinched_vertices(half_edges(surface, silent));
}

}  // namespace holomorph::mesh
