// The edges of polygons, and the sides of polygons at them.
#pragma once

#include <functional>
#include <vector>

#include "base/workers.h"
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

/// #C the corner after each one in its polygon: side c runs from corner c to it.
std::vector<int> next_corners(const Polygons& polygons);

struct LabelledSide {
  int lower, higher, corner;  ///< its labels, and where it starts
};

/// Calls each(begin, end) for the sides between the same two labels, by labels; a group by corners.
/// Cost: O(#C log #C).
void for_edges(const Polygons& polygons, const std::vector<int>& label,
               const std::function<void(const LabelledSide*, const LabelledSide*)>& each);

/// An edge with more faces than this is cut from all of them: its pairs would take the square of their number.
inline constexpr int kMostFacesAtEdge = 64;

/// The sides of each edge that has more than kMostFacesAtEdge.
std::vector<std::vector<int>> crowded_edges(const Polygons& polygons, const std::vector<int>& label);

}  // namespace holomorph::mesh
