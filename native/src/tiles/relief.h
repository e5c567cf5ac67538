// A surface refined where an image of heights on its tiles needs it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tiles/sharp_zones.h"
#include "tiles/tile_coordinates.h"

namespace holomorph::tiles {

/// Heights that are linear on a triangle.
struct HeightTriangle {
  std::array<Point, 3> tiles;
  std::array<double, 3> shares;  ///< of the heights of the image
  std::array<double, 3> heights;
};

/// An image of heights that repeats in every tile, and bounds of what its coarser levels lose.
class HeightImage {
 public:
  using Pixels = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// @param pixels rows from below, at least one pixel, finite. Cost: linear
  explicit HeightImage(Pixels pixels);

  double columns() const { return static_cast<double>(levels_[0].mean.cols()); }
  double rows() const { return static_cast<double>(levels_[0].mean.rows()); }
  int level_count() const { return static_cast<int>(levels_.size()); }

  /// The height at a point in tiles: bilinear between the middles of pixels, of the picture halved `level` times.
  double at(const Point& tile, int level = 0) const { return bilinear(levels_[level].mean, tile[0], tile[1]); }

  /// Bounds how far the image is from `at` of this level, within one pixel of the level around a point.
  double rest(const Point& tile, int level) const;

  /// The largest error of a triangle's heights against those of the image, less a level, at a grid of its points. The
  /// level of the pyramid is so coarse that its pixels cover the gaps of the grid, and the bound of what it loses is
  /// added. 0 for triangles whose sides are shorter than `finest` pixels, and without shares.
  double error(const HeightTriangle& triangle, double level, double finest) const;

 private:
  struct Level {
    Pixels mean;
    Pixels rest;    // in each of its pixels, until the next level is made; none of the finest, which loses nothing
    Pixels around;  // the most of it in a pixel and those around it
  };

  static double bilinear(const Pixels& pixels, double u, double v);
  static Level halved(const Level& fine);

  std::vector<Level> levels_;  // down to a single pixel
};

struct ReliefOptions {
  double level = 0;          ///< the height that is not displaced
  double tolerance = 0;      ///< of heights: triangles are split until no error is larger
  int most_triangles = 0;    ///< beyond this number none is split, whatever its error
  double finest_pixels = 1;  ///< triangles whose sides are shorter are not split
  double depth = 0;          ///< by which a height of 1 moves the surface: so near sharp edges it may lean
};

struct Relief {
  std::vector<std::array<double, 3>> positions;  ///< #V on the surface, its own vertices first
  std::vector<std::array<double, 3>> offsets;    ///< #V by which each is moved, for a depth of 1
  std::vector<double> heights;                   ///< #V of the picture, less the level, times the share
  std::vector<std::array<int, 3>> triangles;     ///< #T
  std::vector<std::array<double, 6>> tiles;      ///< #T tile coordinates of the corners
  std::vector<int> parents;                      ///< #T triangle of the surface in which each lies
  double error = 0;                              ///< largest error of the height on a triangle, where it was measured
  bool is_full = false;                          ///< whether the limit of triangles ended the refinement
};

/// Halves longest sides, in both triangles at once, the triangle with the largest error first. The mesh stays
/// conforming, and no angle gets below half the smallest (Rivara 1984, doi:10.1002/nme.1620200412). Heights are those
/// of the tiles, so that seams of the map are edges as any others. The same at any number of threads: it uses one.
///
/// At a sharp edge, where the normals at corners differ, the surface is moved along both its sides, and farther than
/// the depth from there straight up: triangles that reach from the one to the other are halved.
/// @param sites #V; corners #T. Cost: O(#T log #T) for the triangles that are made.
Relief relief(const mesh::Surface& surface, const TileCoordinates& coordinates, const std::vector<ReliefSite>& sites,
              const std::vector<SmoothCorners>& corners, const HeightImage& image, const ReliefOptions& options,
              Execution& execution);

}  // namespace holomorph::tiles
