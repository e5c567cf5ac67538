// The lines of a surface along which one of its tile coordinates is a whole number.
#pragma once

#include "tiles/pieces.h"

namespace holomorph::tiles {

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
