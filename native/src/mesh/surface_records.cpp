#include "mesh/surface_records.h"

#include <string>

#include "base/chunks.h"
#include "base/errors.h"
#include "mesh/half_edges.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

void record_isolated_vertices(Surface& surface, const HalfEdges& half_edges) {
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (!half_edges.halfedge_handle(VertexHandle(v)).is_valid()) surface.repairs.isolated_vertices.push_back(v);
  }
}

void record_zero_areas(Surface& surface, const MeshLabels& label, Workers& workers) {
  const auto is_zero = [&surface](int t) {
    const auto& [i, j, k] = surface.triangle_edges[t];
    return is_degenerate(surface.edge_lengths[i], surface.edge_lengths[j], surface.edge_lengths[k]);
  };
  const int triangles = static_cast<int>(surface.triangles.size());
  const int count = sum_over_rows(workers, triangles, 0, [&](int t, int& sum) { sum += is_zero(t); });
  if (count == triangles) {
    const std::string which = label.is_part ? "all faces of a part have" : "all faces have";
    throw InvalidMesh(which + " zero area (face " + label.face(0) + " is the first)");
  }
  auto& zero = surface.repairs.zero_area_faces;
  for (int t = 0; count > 0 && t < triangles; ++t) {
    const int face = surface.triangle_faces[t];
    if (is_zero(t) && (zero.empty() || zero.back() != face)) zero.push_back(face);
  }
}

}  // namespace

void record_orientation(Surface& surface, const Orientation& orientation, const MeshLabels& label) {
  if (const int e = orientation.conflict; e >= 0) {
    const auto [a, b] = surface.edges[e];
    throw TopologyError(
        "the surface is non-orientable: its faces cannot be oriented consistently at the edge "
        "between vertices " +
        label.vertex(a) + " and " + label.vertex(b));
  }
  surface.face_component = orientation.face_component;
  surface.component_count = orientation.component_count;
  for (int f = 0; f < static_cast<int>(orientation.reversed.size()); ++f) {
    if (orientation.reversed[f]) surface.repairs.reversed_faces.push_back(f);
  }
}

void finish_records(Surface& surface, Execution& execution, const MeshLabels& label) {
  record_zero_areas(surface, label, execution.workers());
  const HalfEdges half_edges = mesh::half_edges(surface, execution);
  refuse_pinched_vertices(half_edges, execution.workers());
  record_isolated_vertices(surface, half_edges);
}

}  // namespace holomorph::mesh
