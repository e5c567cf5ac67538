#include "mesh/edge_faces.h"

namespace holomorph::mesh {

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

}  // namespace holomorph::mesh
