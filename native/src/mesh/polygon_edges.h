// The edges of a polygon mesh, found from pairs of vertices.
#pragma once

#include <vector>

#include "base/workers.h"
#include "mesh/element_labels.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// Side c runs from polygon corner c to the next corner of the same polygon.
struct PolygonEdges {
  Array<int> side_edge;    ///< #C edge of each side
  Array<Pair> edges;       ///< #E ends, lower vertex first, in lexicographic order
  Array<Pair> edge_sides;  ///< #E the sides at each edge, lower first; -1 where there is only one
  bool oriented = true;    ///< whether the two sides of every edge run in opposite directions
};

/// @pre check_polygons has passed.
/// Cost: linear, in parallel.
/// @throws InvalidMesh for an edge of more than two faces, and for two faces with the same vertices.
PolygonEdges polygon_edges(const Polygons& polygons, const MeshLabels& label, Workers& workers);

/// Returns #V numbers: equal ones at the vertices of one boundary loop, -1 in the interior.
std::vector<int> boundary_loop_of_vertex(const PolygonEdges& edges, int vertex_count);

/// The polygon of each corner.
std::vector<int> corner_faces(const Polygons& polygons);

}  // namespace holomorph::mesh
