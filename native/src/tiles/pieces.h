// The pieces into which the lines between tiles cut the triangles of a surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tiles/triangle_cut.h"

namespace holomorph::tiles {

/// Points of a surface.
struct Locations {
  std::vector<int> triangles;
  std::vector<std::array<double, 3>> barycentric;

  void push_back(int triangle, const std::array<double, 3>& weights) {
    triangles.push_back(triangle);
    barycentric.push_back(weights);
  }
};

/// Piece p has the sides offsets[p] .. offsets[p + 1] - 1, counter-clockwise as its triangle. Each runs from its node
/// to that of the next side. The piece beyond it has the same segment, unless it is on the boundary.
struct Pieces {
  Locations nodes;                                 ///< the vertices first
  std::vector<int> offsets{0};                     ///< #P + 1
  std::vector<int> side_nodes, side_segments;      ///< #S
  std::vector<int> side_turns;                     ///< #S turn from the triangle to the first one at the side's edge
  std::vector<Point> side_points;                  ///< #S tile coordinates of the node in the triangle
  std::vector<std::array<std::int64_t, 2>> tiles;  ///< #P cells of the pattern, in the triangle
  std::vector<int> poles;                          ///< #P the pole in a piece, or -1
  std::vector<char> is_wall;                       ///< of each segment: on a line, the boundary or the star of a pole
  mesh::TurnGroup group;                           ///< in tile coordinates
  Point middle{0.5, 0.5};                          ///< of a cell, from its tile on
};

/// Cost: linear in triangles and pieces. @throws SolverError for too many, Cancelled
Pieces pieces(const mesh::Surface& surface, const TileCoordinates& coordinates, const EdgeNodes& edge_nodes,
              Pattern pattern, Execution& execution);

/// Returns the vertices and the nodes on edges, as TriangleCut numbers them.
Locations edge_locations(const mesh::Surface& surface, const EdgeNodes& edge_nodes);

}  // namespace holomorph::tiles
