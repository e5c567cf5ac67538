// Stitches the sides of polygons together: pairs them at edges of many faces, and joins corners.
#pragma once

#include <array>
#include <vector>

#include "mesh/surface.h"
#include "mesh/union_find.h"

namespace holomorph::mesh {

// Which corners of a polygon mesh may be at one vertex of a surface.

/// Corners with different labels stay apart. In a polygon labels are distinct, and no two polygons have the same set.
struct CornerLabels {
  std::vector<int> label;     ///< #C
  std::vector<int> repeated;  ///< faces that meet a vertex more than once: apart from all others
  std::vector<int> twice;     ///< faces on the vertices of an earlier one, which form sheets of their own
  std::vector<int> opposite;  ///< those of them that run the other way round
};

/// @param vertices #C vertex of each corner
/// Cost: O(#C log #C).
CornerLabels corner_labels(const std::vector<int>& vertices, const std::vector<int>& face_offsets);

/// Returns the pairs of sides that meet at an edge, over all edges, the best first. Pairs that are oriented alike come
/// before others. Then pairs are sorted by the angle between their faces (flat first), convex before concave, and by
/// index.
/// @param label #C; the sides of an edge run between the same two
/// @param reversed #F 1 where the polygon is to be read in reverse
/// @param edges the sides of each edge
/// Cost: the square of the number of sides of an edge.
std::vector<std::array<int, 2>> continuations(const Polygons& polygons, const std::vector<int>& label,
                                              const std::vector<char>& reversed,
                                              const std::vector<std::vector<int>>& edges);

/// Side c runs from corner c of a polygon to its next corner.
struct SideJoins {
  std::vector<int> partner;             ///< #C the side that each one is joined with, -1 if it is left apart
  std::vector<int> fan;                 ///< #C the lowest corner of those that get one vertex
  std::vector<std::vector<int>> many;   ///< sides of edges with three faces or more
  std::vector<std::vector<int>> sided;  ///< the two sides of each edge at which no orientation fits
  SignedSets sheets{{}, {}};            ///< #F faces that hang together, and whether they are read in reverse
};

/// Joins sides so that the polygons become an oriented surface in which an edge is known by its ends.
///
/// Two sides that are the only ones between two labels are joined, unless their orientations contradict. (A flood over
/// the faces decides in which order they are joined.) At edges with more faces, pairs are joined in the order of how
/// well their faces continue each other. First come those that are oriented alike as given, then by the angle, then
/// convex before concave. A pair is left apart where the fans around the ends would become one, though another copy of
/// an edge is there already.
/// @pre crowded_edges is empty
/// Cost: O(#C log #C).
SideJoins join_sides(const Polygons& polygons, const std::vector<int>& label);

}  // namespace holomorph::mesh
