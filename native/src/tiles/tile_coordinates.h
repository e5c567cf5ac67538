// The UVs of a tiling as integers, exactly alike on both sides of every seam. Everything made of a tiling begins with
// them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"
#include "tiles/orientation.h"

namespace holomorph::tiles {

using Corners = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// Defines tile coordinates N (A^-1 uv - origin). Lines and places lie where these are whole numbers.
struct TileFrame {
  Eigen::Matrix2d inverse_lattice;  ///< A^-1, the columns of A the translations by which UVs may jump
  Eigen::Vector2d origin;           ///< in units of the lattice
  Eigen::Matrix2i steps;            ///< N; a row of it may be 0 where one coordinate is enough
};

struct TileCoordinates {
  double unit = 1;                     ///< a power of two, which stands for 1
  Array<std::array<Point, 3>> points;  ///< #T, of the triangles' corners, in integers; jumps are multiples of the unit
  std::vector<char> is_pole;           ///< #V: vertices around which the UVs do not close up by whole tiles
  bool is_mirrored = false;            ///< most of the area is clockwise
};

/// Computes the tile coordinates. Each vertex is rounded once, and moved by the jumps: so it has the same place in all
/// its triangles, up to whole tiles.
/// @param uv #C x 2
/// @throws TopologyError where UVs are not those of a tiling, naming the place: not finite, too large, a jump that is
/// no whole number of tiles, or one that differs at the two ends of an edge. SolverError for more tiles than memory is
/// meant for
TileCoordinates tile_coordinates(const mesh::Surface& surface, const Eigen::Ref<const Corners>& uv,
                                 const TileFrame& frame, Execution& execution);

/// Twice the signed area of triangle t, in squares of the unit, positive as most are; exactly 0 where it is.
inline double signed_area(const TileCoordinates& coordinates, int t) {
  const auto& [a, b, c] = coordinates.points[t];
  const double area = orientation(a, b, c);
  return coordinates.is_mirrored ? -area : area;
}

}  // namespace holomorph::tiles
