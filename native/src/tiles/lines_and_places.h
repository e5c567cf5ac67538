// The points of a surface at which its tile coordinates are whole numbers, and the lines along which one of them is.
#pragma once

#include <vector>

#include "tiles/pieces.h"
#include "tiles/tile_coordinates.h"

namespace holomorph::tiles {

struct Places {
  std::vector<int> triangles;                        ///< in which each lies, ascending
  std::vector<std::array<double, 3>> barycentric;    ///< there, not negative
  std::vector<std::array<std::int64_t, 2>> numbers;  ///< the whole numbers
  int flipped = 0;                                   ///< in flipped triangles, which are left out
};

/// Finds all such points, each once, in the order of the triangles, then of the rows and in each row. A point on an
/// edge belongs to the triangle that it is in when all points move a little, by (d, d^2). So one of two adjacent
/// triangles has it, of a fold both or none, and the number of points less `flipped` is that of the map's degree. A
/// point at a vertex belongs to the first triangle there, also where the map branches. Points on the boundary are
/// included. Triangles at a pole have UVs of their own: each counts the points in it, whatever lies in the next.
/// Cost: linear in triangles, rows in these and places, in parallel; the same at any number of threads. @throws
/// SolverError for too many, Cancelled
Places places(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution);

/// Line l has the points offsets[l] .. offsets[l + 1] - 1, the first not repeated where it closes.
struct Lines {
  Locations points;
  std::vector<int> offsets{0};  ///< #L + 1
  std::vector<char> is_closed;  ///< #L
};

/// Finds all lines of the first coordinate, from edge to edge. A line ends on the boundary, at the star of a pole, and
/// where other lines meet it, as at a branch point. The order is that of the first edges.
/// Cost: linear in triangles and points. @throws SolverError for too many points, Cancelled
Lines lines(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution);

}  // namespace holomorph::tiles
