#include "openmesh/attributes.h"

#include <string>

namespace holomorph::openmesh::detail {

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

}  // namespace holomorph::openmesh::detail
