// Surfaces cut open along some of their edges.
#pragma once

#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::mesh {

// Slivers: polygons without area, which belong to the piece of a neighbour wherever a surface is cut.

/// Returns whether each polygon is a sliver, #F: all its triangles are degenerate, or so low that their normals are
/// rounding: their heights over their longest sides are at most kLow of these, and the rounding of their coordinates
/// to single precision or six decimals.
std::vector<char> slivers(const Surface& surface);

/// Returns the cut, #E, without the edges that would leave a part of slivers alone: one after the other, the longest
/// first, an edge joins two parts unless both have other polygons. So a sliver is in the piece beyond its longest side,
/// or that of the sliver there. Parts of slivers that no such edge joins to others stay.
/// @param is_cut #E; diagonals are never cut
/// Cost: O(#E log #E) where there are slivers, else O(#T).
std::vector<char> cut_without_sliver_parts(const Surface& surface, std::vector<char> is_cut);

/// Returns the polygon that each polygon belongs to where all edges are cut, #F: itself, but for slivers beside others.
std::vector<int> sliver_owners(const Surface& surface);

// Shortest paths along the edges of polygons to a border: where to cut a surface open.

/// Whether a vertex lies on the boundary or at one of the cuts, #V. @param is_cut #E; empty: none
std::vector<char> on_border(const Surface& surface, const std::vector<char>& is_cut);

/// A forest whose roots are the vertices of the border.
struct BorderPaths {
  std::vector<double> distances;    ///< #V; infinite where no path leads to the border
  std::vector<int> edge_to_border;  ///< #V the first edge of the path, the lowest of equals; -1 at its end

  /// Marks the path from a vertex, as far as it is not marked yet. @param is_marked #E
  void mark(const Surface& surface, int vertex, std::vector<char>& is_marked) const;
};

/// @param is_border #V. @param times #E, by which lengths are multiplied; empty: 1. Cost: O(n log n)
BorderPaths border_paths(const Surface& surface, const std::vector<char>& is_border, const std::vector<double>& times,
                         Execution& execution);

/// Returns the paths from these vertices to the border, #E. @param starts #V
std::vector<char> paths_to_border(const Surface& surface, const std::vector<char>& is_border,
                                  const std::vector<char>& starts, Execution& execution);

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
