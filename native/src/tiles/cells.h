// A surface with one polygon for each tile.
#pragma once

#include "tiles/pieces.h"

namespace holomorph::tiles {

/// Polygon f has the corners offsets[f] .. offsets[f + 1] - 1, counter-clockwise as the triangles.
struct Cells {
  Locations vertices;                              ///< on the surface that is cut
  std::vector<int> offsets{0};                     ///< #F + 1
  std::vector<int> corner_vertices;                ///< #C
  std::vector<Point> corner_points;                ///< #C tile coordinates, of one polygon in one chart
  std::vector<char> is_needed;                     ///< #V: not between two others on the side of a cell
  std::vector<std::array<std::int64_t, 2>> tiles;  ///< #F
  std::vector<int> poles;                          ///< #F the pole whose star a polygon is, or -1
  std::vector<char> is_whole;                      ///< #F: a whole cell, not a part of one
  std::vector<int> turns;                          ///< #F: once around it, where a cone lies in it; else 0
};

/// Joins the pieces of each tile to a polygon, and so the triangles of each pole's star. A tile may have a hole, or
/// meet itself around a limb: what is not a disk with a simple outline is cut into a few disks. So polygons fit side by
/// side, and the Euler characteristic is that of the surface.
/// Cost: nearly linear. @throws Cancelled
Cells cells(const Pieces& pieces, Execution& execution);

}  // namespace holomorph::tiles
