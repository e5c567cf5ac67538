// The UVs of a tiling as integers, exactly alike on both sides of every seam. Everything made of a tiling begins with
// them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/double_double.h"
#include "base/execution.h"
#include "mesh/corner_turns.h"
#include "mesh/surface.h"

namespace holomorph::tiles {

using Point = std::array<double, 2>;

inline constexpr int kNone = -1;

/// Largest coordinate. Differences of coordinates are exact, and products are exact in twice the precision.
inline constexpr double kLargestCoordinate = 0x1p50;

/// a d - b c, rounded, with the right sign and exactly 0 where it is. @pre integers up to 2 kLargestCoordinate
inline double determinant(double a, double b, double c, double d) {
  const DoubleDouble p = exact_product(a, d), q = exact_product(b, c);
  // Where the first difference is rounded, it is more than the second; else the sum is one of integers.
  return (p.high - q.high) + (p.low - q.low);
}

/// Twice the signed area of (a, b, x): positive where x lies on the left of the line from a to b.
inline double orientation(const Point& a, const Point& b, const Point& x) {
  return determinant(b[0] - a[0], b[1] - a[1], x[0] - a[0], x[1] - a[1]);
}

using Corners = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// Defines tile coordinates N (A^-1 uv - origin). Lines and places lie where these are whole numbers.
struct TileFrame {
  Eigen::Matrix2d inverse_lattice;  ///< A^-1, the columns of A the translations by which UVs may jump
  Eigen::Vector2d origin;           ///< in units of the lattice
  Eigen::Matrix2i steps;            ///< N; a row of it may be 0 where one coordinate is enough
  /// k, where UVs also turn by 2 pi / k: 2 or 4. Then N is as the turns leave it, and 2 N origin is whole.
  int turns = 1;
};

struct TileCoordinates {
  double unit = 1;                     ///< a power of two, which stands for 1
  Array<std::array<Point, 3>> points;  ///< #T, of the triangles' corners, in integers; jumps are multiples of the unit
  std::vector<char> is_pole;           ///< #V: vertices around which the UVs do not close up by whole tiles
  bool is_mirrored = false;            ///< most of the area is clockwise
  mesh::TurnGroup group;               ///< in tile coordinates
  mesh::CornerTurns turns;
};

/// From tile coordinates in one triangle to those in another: x' = R^turn x + translation, in whole tiles.
struct Transition {
  int turn = 0;
  std::array<std::int64_t, 2> translation{};
};

/// Computes the tile coordinates. Each vertex is rounded once, and moved by the jumps: so it has the same place in all
/// its triangles, up to turns and whole tiles. A cone lies at a centre of turns.
/// @param uv #C x 2
/// @throws TopologyError where UVs are not those of a tiling, naming the place: not finite, too large, a jump that is
/// no whole number of tiles, or one that differs at the two ends of an edge
TileCoordinates tile_coordinates(const mesh::Surface& surface, const Eigen::Ref<const Corners>& uv,
                                 const TileFrame& frame, Execution& execution);

/// From a triangle to another one whose coordinates are turned against it. @param from, to a point in both
inline Transition transition(const TileCoordinates& coordinates, int turn, const Point& from, const Point& to) {
  const Eigen::Vector2d turned = coordinates.group.power(turn) * Eigen::Vector2d(from[0], from[1]);
  return {turn,
          {static_cast<std::int64_t>((to[0] - turned[0]) / coordinates.unit),
           static_cast<std::int64_t>((to[1] - turned[1]) / coordinates.unit)}};
}

/// Refuses what would take more than a gigabyte, and more than 100 kB a vertex. @throws SolverError
/// @param count of things to be made, with so many bytes each; things as in "the surface has 10 <things>"
void refuse_too_many(const mesh::Surface& surface, double count, double bytes, const std::string& things);

/// Twice the signed area of triangle t, in squares of the unit, positive as most are; exactly 0 where it is.
inline double signed_area(const TileCoordinates& coordinates, int t) {
  const auto& [a, b, c] = coordinates.points[t];
  const double area = orientation(a, b, c);
  return coordinates.is_mirrored ? -area : area;
}

/// The area of triangle t in tiles.
inline double tiles_in(const TileCoordinates& coordinates, int t) {
  return std::abs(signed_area(coordinates, t)) / 2 / (coordinates.unit * coordinates.unit);
}

}  // namespace holomorph::tiles
