// The edges of a polygon mesh, found from pairs of vertices: the only place where an edge is known by its ends.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace holomorph::mesh {

/// Side c runs from polygon corner c to the next corner of the same polygon.
struct PolygonEdges {
  std::vector<int> side_edge;    ///< #C edge of each side
  std::vector<Pair> edges;       ///< #E ends, lower vertex first, in lexicographic order
  std::vector<Pair> edge_sides;  ///< #E the sides at each edge, lower first; -1 where there is only one
};

/// @pre check_polygons has passed.
/// @throws InvalidMesh for an edge of more than two faces, and for two faces with the same vertices.
PolygonEdges polygon_edges(const Polygons& polygons);

/// #V: equal numbers at the vertices of one boundary loop, -1 in the interior.
std::vector<int> boundary_loop_of_vertex(const PolygonEdges& edges, int vertex_count);

/// The polygon of each corner.
std::vector<int> corner_faces(const Polygons& polygons);

/// The corner after `corner` in its polygon `face`.
inline int next_corner(const Polygons& polygons, int face, int corner) {
  return corner + 1 == polygons.face_offsets[face + 1] ? static_cast<int>(polygons.face_offsets[face]) : corner + 1;
}

}  // namespace holomorph::mesh
