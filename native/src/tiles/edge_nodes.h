// Where edges cross the lines between tiles.
#pragma once

#include <cstdint>

#include "tiles/tile_coordinates.h"

namespace holomorph::tiles {

/// Tile coordinates as far as combinatorics need them: 2 m where one is the whole number m, 2 m + 1 between m and m
/// + 1.
using Code = std::array<std::int64_t, 2>;

inline bool is_line(std::int64_t code) { return code % 2 == 0; }

/// The nodes on edge e are offsets[e] .. offsets[e + 1] - 1. They follow side i of the first triangle t at the edge,
/// with 3 t + i = sides[e]. An edge that ends at a pole has none.
struct EdgeNodes {
  std::vector<int> sides;       ///< #E
  std::vector<int> offsets;     ///< #E + 1
  std::vector<Code> codes;      ///< in that triangle
  std::vector<double> weights;  ///< of the end of the side, strictly between 0 and 1
};

/// Finds the nodes strictly between the ends of each edge, in an order that is decided exactly. A crossing of two lines
/// at one point is one node.
/// Cost: linear in edges and nodes. @throws SolverError for too many
EdgeNodes edge_nodes(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution);

/// Returns the code of a point, whose coordinates are integers.
Code code_of(const Point& point, double unit);

}  // namespace holomorph::tiles
