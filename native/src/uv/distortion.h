// How a UV map distorts a mesh, polygon by polygon. Any UV map and any mesh will do: nothing is solved, and the mesh
// need not be a surface that can be. `Quality` measures triangles of surfaces.
#pragma once

#include "base/page_allocator.h"
#include "mesh/surface.h"
#include "uv/direction.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

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
