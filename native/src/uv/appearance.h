// How far a map is from one on which a texture looks as on flat paper, as one number: 0 is perfect.
//
// The prices were judged by eye on pictures of some thirty meshes beside Smart UV Project. Squares of 1 to 2 side by
// side, a size range of 2, are as bad as a mean shear of 1.7, as a seam nearly three times the size of the surface
// where it is smooth, or as four dozen poles. A seam along a hard edge, where the light breaks too, is hardly seen.
// Rows of squares that turn on their way round a tube by 27 degrees in the mean, as on a lamp shade unrolled, are as
// bad, too.
#pragma once

#include "base/page_allocator.h"
#include "mesh/surface.h"
#include "uv/direction.h"
#include "uv/quality.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

inline constexpr double kShear = 2;        ///< for 1 more of the mean s1 / s2, where an e-fold density ratio costs 1
inline constexpr double kFlipped = 20;     ///< for the whole area
inline constexpr double kRounding = 1e-6;  ///< part of the map: less of an overlap is none
inline constexpr double kSeam = 0.5;       ///< for a seam as long as the square root of the area, where it is smooth
inline constexpr double kHardSeam = 0.03;  ///< and along hard edges
inline constexpr double kPole = 0.03;
inline constexpr double kCone = 0.005;  ///< of a tiling that turns: three or five squares meet
/// For a radian by which rows of squares that could run round a tube turn away from that, in the mean.
inline constexpr double kTurn = 3;
/// For the whole area, as far as it is steep: of a texture that lies on its side, and that stands on its head.
inline constexpr double kSideways = 1, kOnItsHead = 0.5;

/// What an eye minds of a map besides its squares.
struct Marks {
  double soft_seams = 0, hard_seams = 0;  ///< lengths over the square root of the area
  int poles = 0, cones = 0;
};

/// What it minds of its squares, as `Quality` has it.
struct Squares {
  double density_ratio = 1, mean_angle = 1, flipped_part = 0, overlapping_part = 0;
};

/// The cost of squares that differ, are sheared, flipped or lie over each other; infinite with collapsed parts.
double cost_of_squares(const Squares& squares);
double cost_of_squares(const Quality& quality);
/// The cost of what lies over itself: a texture that tiles does not show it.
double cost_of_overlaps(double overlapping_part);
/// The cost of a texture that does not stand upright, by the sine of the angle.
double cost_of_direction(const Direction& direction);
double cost_of_marks(const Marks& marks);
/// The cost of a map to the eye; infinite for one with collapsed parts.
double cost(const Quality& quality, const Marks& marks = {});

// How a UV map distorts a mesh, polygon by polygon. Any UV map and any mesh will do: nothing is solved, and the mesh
// need not be a surface that can be. `Quality` measures triangles of surfaces.

inline constexpr double kMostOctaves = 16;      ///< a density beyond is one of a collapsed polygon
inline constexpr double kCollapsedAngle = 1e3;  ///< s1 / s2 of a collapsed polygon

/// s1 >= s2 are the singular values of the map of each triangle; a polygon has the mean of its triangles by area.
/// Finite everywhere: polygons without area have the density of the median and angle 1, and those that are not steep
/// the direction 0.
struct Distortion {
  Array<double> density;    ///< #F log2 of UV area per surface area (s1 s2) over its median by area
  Array<double> angle;      ///< #F s1 / s2
  Array<double> direction;  ///< #F degrees between the gradient of v and what is up, see `Direction`
  double size_range = 1;    ///< of the sides of squares: root of the 95 % over 5 % quantile of the density, by area
  double mean_angle = 1;    ///< by area, each polygon with `kMostAngle` at most
  double upright_part = 1;  ///< of the steep area
};

/// Measures a #C x 2 map of the polygons' corners on the triangles between the first corner of each polygon and the
/// others. Cost: O(#C)
Distortion distortion(const mesh::Polygons& polygons, const Eigen::Ref<const UvArray>& uv, Up up, Workers& workers);

/// UV area per surface area: quantiles by area over the triangles that are drawn; 0 where there is no area.
struct Densities {
  double low = 0, median = 0, high = 0;
};
Densities drawn_densities(const mesh::Polygons& polygons, const Eigen::Ref<const UvArray>& uv, Workers& workers);

}  // namespace holomorph::uv
