// Distortion of UV maps.
#pragma once

#include <vector>

#include "base/page_allocator.h"
#include "base/workers.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

/// What s1 / s2 counts at most in its mean, so that no single triangle decides it; also that of a collapsed one.
inline constexpr double kMostAngle = 10;

struct Quality {
  /// #T s1 / s2 >= 1, the singular values of the map; 1 where the triangle has no area, infinite where it has collapsed
  /// or a UV is not finite
  Array<double> angle;
  Array<double> area;         ///< #T s1 s2, UV area per surface area; 0 where the triangle has no area or has collapsed
  Array<char> flipped;        ///< #T 1 where the map reverses the orientation
  double mean_angle = 0;      ///< s1 / s2, mean over the area; each triangle counts with at most `kMostAngle`
  double density_ratio = 0;   ///< 95 % over 5 % quantile of s1 s2, by the surface's area; infinite where that is 0
  double median_density = 0;  ///< 50 % quantile of s1 s2, by the surface's area
};

/// Measures a UV map. @param uv #C x 2. The sums are in a fixed order, so the bits do not depend on the number of
/// threads. Cost: O(#T).
Quality quality(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, Workers& workers);

}  // namespace holomorph::uv
