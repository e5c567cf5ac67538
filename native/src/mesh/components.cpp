#include "mesh/components.h"

#include <algorithm>
#include <numeric>

#include "mesh/intrinsic_surface.h"
#include "mesh/make_surface.h"

namespace holomorph::mesh {
namespace {

// Rebuilds an intrinsic component from its triangles as given (before any was reversed), edges by name.
Surface intrinsic_part(const Surface& parent, const std::vector<int>& faces, const std::vector<int>& new_vertex,
                       int vertex_count, Execution& execution) {
  std::vector<char> reversed(parent.triangles.size(), 0);
  for (const int f : parent.repairs.reversed_faces) reversed[f] = 1;
  std::vector<std::array<std::int64_t, 3>> triangles, names;
  std::vector<std::array<double, 3>> lengths;
  for (const int f : faces) {
    Triple v = parent.triangles[f], side = parent.triangle_edges[f];
    if (reversed[f]) std::swap(v[1], v[2]), std::swap(side[0], side[2]);
    std::array<std::int64_t, 3> vertices, name;
    std::array<double, 3> length;
    for (int i = 0; i < 3; ++i) {
      vertices[i] = new_vertex[v[i]];
      name[i] = side[(i + 1) % 3];  // corner i lies opposite side i + 1
      length[i] = parent.edge_lengths[side[(i + 1) % 3]];
    }
    triangles.push_back(vertices);
    names.push_back(name);
    lengths.push_back(length);
  }
  return make_intrinsic_surface(vertex_count, triangles, lengths, names, execution);
}

}  // namespace

Component component(const Surface& parent, int which, Execution& execution) {
  Component part;
  const Polygons& mesh = parent.polygons;
  std::vector<int> new_vertex(parent.vertex_count, -1);
  for (int f = 0; f < static_cast<int>(parent.face_component.size()); ++f) {
    if (parent.face_component[f] != which) continue;
    part.face_index.push_back(f);
    for (auto c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) {
      part.corner_index.push_back(static_cast<int>(c));
      new_vertex[mesh.corner_vertices[c]] = 0;
    }
  }
  for (int v = 0; v < parent.vertex_count; ++v) {
    if (new_vertex[v] < 0) continue;
    new_vertex[v] = static_cast<int>(part.vertex_index.size());
    part.vertex_index.push_back(v);
  }
  if (parent.intrinsic()) {
    const int vertex_count = static_cast<int>(part.vertex_index.size());
    part.surface = intrinsic_part(parent, part.face_index, new_vertex, vertex_count, execution);
    return part;
  }
  Polygons polygons;
  for (const int v : part.vertex_index) polygons.vertices.push_back(mesh.vertices[v]);
  polygons.face_offsets.push_back(0);
  for (const int f : part.face_index) {
    for (auto c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c)
      polygons.corner_vertices.push_back(new_vertex[mesh.corner_vertices[c]]);
    polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
  }
  part.surface = make_surface(std::move(polygons), execution);
  return part;
}

int euler_characteristic(const Surface& surface) {
  return surface.vertex_count - static_cast<int>(surface.repairs.isolated_vertices.size()) -
         static_cast<int>(surface.edges.size()) + static_cast<int>(surface.triangles.size());
}

int boundary_count(const Surface& surface) {
  // On each loop there are as many edges as vertices, and all but one join two parts of it.
  std::vector<int> part(surface.vertex_count);
  std::iota(part.begin(), part.end(), 0);
  const auto find = [&part](int v) {
    while (part[v] != v) v = part[v] = part[part[v]];
    return v;
  };
  int loops = 0;
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (surface.edge_face_count[e] != 1) continue;
    const int a = find(surface.edges[e][0]), b = find(surface.edges[e][1]);
    if (a == b)
      ++loops;
    else
      part[std::max(a, b)] = std::min(a, b);
  }
  return loops;
}

std::string TopologicalType::text() const {
  return "genus " + std::to_string(genus) + " and " + std::to_string(boundary_count) + " boundary loops";
}

TopologicalType topological_type(const Surface& surface) {
  const int boundaries = boundary_count(surface);
  return {(2 - euler_characteristic(surface) - boundaries) / 2, boundaries};
}

}  // namespace holomorph::mesh
