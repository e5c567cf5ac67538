// An image of heights that repeats in every tile, and bounds of what its coarser levels lose.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tiles/tile_coordinates.h"

namespace holomorph::tiles {

/// Heights that are linear on a triangle.
struct HeightTriangle {
  std::array<Point, 3> tiles;
  std::array<double, 3> shares;  ///< of the heights of the image
  std::array<double, 3> heights;
};

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

}  // namespace holomorph::tiles
