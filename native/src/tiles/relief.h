// A surface refined where an image of heights on its tiles needs it.
#pragma once

#include <Eigen/Core>

#include "tiles/height_image.h"
#include "tiles/sharp_zones.h"
#include "tiles/tile_coordinates.h"

namespace holomorph::tiles {

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
