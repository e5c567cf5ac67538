#include "openmesh/surface_of_mesh.h"

#include <utility>

#include "mesh/components.h"
#include "mesh/make_surface.h"

namespace holomorph::openmesh {
namespace {

using OpenMesh::HalfedgeHandle;

HalfedgeHandle opposite(HalfedgeHandle h) { return HalfedgeHandle(h.idx() ^ 1); }

// The half-edge of the mesh that runs from corner a to corner b, neighbours in their polygon: it ends at the later one.
HalfedgeHandle side(const SurfaceOfMesh& part, int face, int a, int b) {
  const auto& offsets = part.surface->polygons.face_offsets;
  const bool forward = b == a + 1 || (a == offsets[face + 1] - 1 && b == offsets[face]);
  return forward ? part.corners[b] : opposite(part.corners[a]);
}

std::vector<HalfedgeHandle> half_edges_of_edges(const SurfaceOfMesh& part) {
  const mesh::Surface& surface = *part.surface;
  std::vector<HalfedgeHandle> edges(surface.polygon_edge_count);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int e = surface.triangle_edges[t][i];
      if (surface.is_diagonal(e)) continue;
      const int j = (i + 1) % 3;
      const auto& corners = surface.triangle_corners[t];
      HalfedgeHandle h = side(part, surface.triangle_faces[t], corners[i], corners[j]);
      if (surface.triangles[t][i] > surface.triangles[t][j]) h = opposite(h);
      if (edges[e].is_valid() && edges[e] != h) {
        throw InvalidMesh("edges " + std::to_string(edges[e].idx() / 2) + " and " + std::to_string(h.idx() / 2) +
                          " have the same ends");
      }
      edges[e] = h;
    }
  }
  return edges;
}

template <class Handle>
std::vector<Handle> chosen(const std::vector<Handle>& handles, const std::vector<int>& which) {
  std::vector<Handle> result;
  result.reserve(which.size());
  for (const int i : which) result.push_back(handles[i]);
  return result;
}

}  // namespace

namespace detail {

void require_count(std::ptrdiff_t given, const char* what, std::size_t count, const char* elements) {
  if (given == static_cast<std::ptrdiff_t>(count)) return;
  throw InvalidMesh(std::to_string(given) + " " + what + " do not fit a surface with " + std::to_string(count) + " " +
                    elements);
}

void require_edges(std::span<const int> edges, const SurfaceOfMesh& part) {
  for (const int e : edges) {
    if (e < 0 || e >= static_cast<int>(part.edges.size())) {
      throw InvalidMesh("edge " + std::to_string(e) + " is not an edge of the mesh: the surface has " +
                        std::to_string(part.edges.size()) + " edges of polygons");
    }
  }
}

void throw_changed(OpenMesh::HalfedgeHandle h, OpenMesh::VertexHandle v) {
  throw InvalidMesh("the mesh has changed since its surface was made: half-edge " + std::to_string(h.idx()) +
                    " was a face's and ended at vertex " + std::to_string(v.idx()));
}

SurfaceOfMesh finish(SurfaceOfMesh part, mesh::Polygons polygons, bool left_out, Execution& execution) {
  try {
    part.surface = std::make_shared<const mesh::Surface>(mesh::make_surface(std::move(polygons), execution));
  } catch (const InvalidMesh& error) {
    if (!left_out) throw;
    throw InvalidMesh(std::string(error.what()) +
                      " (numbered without deleted elements and isolated vertices of the OpenMesh mesh)");
  }
  part.edges = half_edges_of_edges(part);
  return part;
}

}  // namespace detail

std::vector<SurfaceOfMesh> components(const SurfaceOfMesh& whole, Execution& execution) {
  if (whole.surface->component_count == 1) return {whole};
  std::vector<SurfaceOfMesh> parts;
  for (mesh::Component& component : mesh::components(*whole.surface, execution)) {
    SurfaceOfMesh& part = parts.emplace_back();
    part.surface = std::make_shared<const mesh::Surface>(std::move(component.surface));
    part.vertices = chosen(whole.vertices, component.vertex_index);
    part.faces = chosen(whole.faces, component.face_index);
    part.corners = chosen(whole.corners, component.corner_index);
    part.edges = half_edges_of_edges(part);
  }
  return parts;
}

}  // namespace holomorph::openmesh
