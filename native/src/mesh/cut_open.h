// Surfaces cut open along some of their edges.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

/// The vertices of a surface that is cut: each has a copy for each fan of triangles that the cuts leave at it.
struct PartedVertices {
  std::vector<int> vertices;         ///< the vertex that each copy is of, ascending
  std::vector<Triple> of_triangles;  ///< #T the copies at the corners of each triangle
};

/// @param is_cut #E. Cost: O(#T)
PartedVertices parted_vertices(const Surface& surface, const std::vector<char>& is_cut);

struct OpenSurface {
  Surface surface;                ///< with the polygons and corners of the one that was cut
  std::vector<int> vertex_index;  ///< #V the vertex that each is a copy of, ascending
};

/// Cuts the surface open, but leaves no sliver without the neighbour at its longest side: no part is without area.
/// @param is_cut #E; diagonals are never cut. @throws InvalidMesh
OpenSurface cut_open(const Surface& surface, const std::vector<char>& is_cut, Execution& execution);

/// Numbers the parts into which the same cuts divide the polygons, #F, from 0 on by their first polygon.
std::vector<int> parts(const Surface& surface, const std::vector<char>& is_cut);

/// Whether an edge lies between polygons of different names, #E. @param names #F
std::vector<char> edges_between(const Surface& surface, const std::vector<int>& names);

struct OrientedSurface {
  Surface surface;
  std::vector<int> corner_index;  ///< #C the corner as given that each is; empty where that is its own
};

/// Turns polygons round that were read in reverse: parts of a surface that is cut would be oriented each by itself.
OrientedSurface in_one_orientation(const Surface& surface, Execution& execution);

}  // namespace holomorph::mesh
