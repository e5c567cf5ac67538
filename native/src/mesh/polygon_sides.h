// Groups the sides of polygons by edge, where labels of corners tell which sides meet.
#pragma once

#include <functional>
#include <vector>

#include "mesh/polygons.h"

namespace holomorph::mesh {

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
