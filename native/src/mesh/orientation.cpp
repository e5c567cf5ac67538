#include "mesh/orientation.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "base/errors.h"
#include "base/workers.h"
#include "mesh/half_edges.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// The meetings of each face: entries first[f] .. first[f+1]-1 of `meeting`.
struct FaceMeetings {
  std::vector<int> first, meeting;

  FaceMeetings(int face_count, const std::vector<EdgeMeeting>& meetings)
      : first(face_count + 1, 0), meeting(2 * meetings.size()) {
    for (const auto& m : meetings) ++first[m.face + 1], ++first[m.other_face + 1];
    for (int f = 0; f < face_count; ++f) first[f + 1] += first[f];
    std::vector<int> next(first.begin(), first.end() - 1);
    for (int i = 0; i < static_cast<int>(meetings.size()); ++i) {
      meeting[next[meetings[i].face]++] = i;
      meeting[next[meetings[i].other_face]++] = i;
    }
  }
};

// #V: the lowest vertex that each is connected with.
std::vector<int> lowest_connected(int vertex_count, const Array<Pair>& edges) {
  std::vector<int> lower(vertex_count);  // a vertex connected with each, not above it
  std::iota(lower.begin(), lower.end(), 0);
  // First a lower neighbour of each, and what that leads to: mostly the answer.
  for (const auto& [a, b] : edges) lower[b] = a;
  for (int v = 0; v < vertex_count; ++v) lower[v] = lower[lower[v]];
  const auto lowest = [&lower](int v) {
    while (lower[v] != v) v = lower[v] = lower[lower[v]];
    return v;
  };
  for (const auto& [a, b] : edges) {
    const int i = lowest(a), j = lowest(b);
    lower[std::max(i, j)] = std::min(i, j);
  }
  for (int v = 0; v < vertex_count; ++v) lower[v] = lower[lower[v]];
  return lower;
}

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

Orientation orient(int face_count, const std::vector<EdgeMeeting>& meetings) {
  const FaceMeetings around(face_count, meetings);
  Orientation result;
  result.reversed.assign(face_count, 0);
  result.face_component.assign(face_count, -1);
  std::vector<int> flood;
  for (int start = 0; start < face_count; ++start) {
    if (result.face_component[start] >= 0) continue;
    const int component = result.component_count++;
    flood.assign(1, start);
    result.face_component[start] = component;
    int reversed_count = 0;
    for (std::size_t head = 0; head < flood.size(); ++head) {
      const int f = flood[head];
      for (int i = around.first[f]; i < around.first[f + 1]; ++i) {
        const EdgeMeeting& m = meetings[around.meeting[i]];
        const int g = m.face == f ? m.other_face : m.face;
        const char wanted = result.reversed[f] ^ static_cast<char>(m.same_direction);
        if (result.face_component[g] < 0) {
          result.face_component[g] = component;
          result.reversed[g] = wanted;
          reversed_count += wanted;
          flood.push_back(g);
        } else if (result.reversed[g] != wanted) {
          // Two ways to this face orient it differently: there is a Moebius band.
          result.conflict = m.edge;
          return result;
        }
      }
    }
    if (2 * static_cast<std::size_t>(reversed_count) > flood.size()) {
      for (const int f : flood) result.reversed[f] ^= 1;
    }
  }
  return result;
}

Orientation oriented_as_given(const Polygons& mesh, const Array<Pair>& edges) {
  const int vertex_count = static_cast<int>(mesh.vertices.size());
  const int face_count = static_cast<int>(mesh.face_offsets.size()) - 1;
  const std::vector<int> root = lowest_connected(vertex_count, edges);
  Orientation result;
  result.reversed.assign(face_count, 0);
  result.face_component.resize(face_count);
  std::vector<int> number(vertex_count, -1);  // component of each root
  for (int f = 0; f < face_count; ++f) {
    int& component = number[root[mesh.corner_vertices[mesh.face_offsets[f]]]];
    if (component < 0) component = result.component_count++;
    result.face_component[f] = component;
  }
  return result;
}

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
