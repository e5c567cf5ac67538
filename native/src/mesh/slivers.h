// Slivers: polygons without area, which belong to the piece of a neighbour wherever a surface is cut.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace holomorph::mesh {

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

}  // namespace holomorph::mesh
