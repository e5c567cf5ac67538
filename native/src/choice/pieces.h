// The pieces of a part between its hard edges, and those that whole tiles would suit better than flat islands. Windows
// in tubes, such as where a handle is fixed, are closed for the map.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "choice/map.h"
#include "flat/pieces.h"

namespace holomorph::choice {

/// Radians by which rows of squares of a piece's islands turn against those of another map of it, in the mean over the
/// area; 0 without islands.
double turn_against(const Piece& piece, const uv::UvArray& other);

/// The components of a part that is cut between polygons of different names, #F.
std::vector<Piece> cut_apart(const Part& part, const std::vector<int>& names, Execution& execution);

/// The part cut open between its tips where few see it, as a piece with the name 0; and how far the cut is seen. None
/// where it would fall apart (flat/pieces.h).
std::optional<std::pair<Piece, double>> cut_in_hiding(const Part& part, bool is_upright, Execution& execution);

/// The pieces with `names` that are tubes, or smooth, and across which islands have a seam or stretch, the largest
/// first. @param flat the islands of the part; null without any
std::vector<Piece> smooth_pieces(const Part& part, const flat::Layout* flat, const std::vector<int>& names,
                                 Execution& execution);

/// The part with one more polygon, at the end, in each boundary loop but the two longest; itself where there are no
/// more. Vertices, polygons and corners keep their numbers. @throws InvalidMesh where a window is not a polygon
PartPointer closed(const PartPointer& part, Execution& execution);

/// The tiling of a part with closed windows, on the part itself.
MapPointer opened(const MapPointer& made, const PartPointer& part, Execution& execution);

/// Pairs of vertices in ascending order, the lower vertex of each first.
std::vector<mesh::Pair> sorted_pairs(std::vector<mesh::Pair> pairs);
/// Whether two vertices are one of the `sorted_pairs`. Cost: log n
bool holds(const std::vector<mesh::Pair>& pairs, int a, int b);

}  // namespace holomorph::choice
