// Distortion of UV maps.
#pragma once

#include <optional>
#include <vector>

#include "base/page_allocator.h"
#include "base/workers.h"
#include "uv/direction.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

/// What s1 / s2 counts at most in its mean, so that no single triangle decides it; also that of a collapsed one.
inline constexpr double kMostAngle = 10;

/// Angle distortion that evening may add unseen at evenness 1: it is spread out, and squares have one size.
inline constexpr double kUnseen = 0.3;

struct Quality {
  /// #T s1 / s2 >= 1, the singular values of the map; 1 where the triangle has no area, infinite where it has collapsed
  /// or a UV is not finite
  Array<double> angle;
  Array<double> area;         ///< #T s1 s2, UV area per surface area; 0 where the triangle has no area or has collapsed
  Array<char> flipped;        ///< #T 1 where the map reverses the orientation
  Array<double> weights;      ///< #T areas on the surface; 1 each where all are 0
  double flipped_part = 0;    ///< part of the area that is flipped
  double lost_part = 0;       ///< that is flipped or has collapsed
  double mean_angle = 0;      ///< s1 / s2, mean over the area; each triangle counts with at most `kMostAngle`
  double density_ratio = 0;   ///< 95 % over 5 % quantile of s1 s2, by the surface's area; infinite where that is 0
  double median_density = 0;  ///< 50 % quantile of s1 s2, by the surface's area
  /// The part of its region in the plane that a map with a free boundary covers more than once; none of others.
  std::optional<double> overlapping_part = {};
  double unseen_angle = 0;                  ///< what evening added to `mean_angle`, as far as it is not seen
  std::optional<Direction> direction = {};  ///< none where nothing is to be upright
};

/// Measures a UV map. @param uv #C x 2. The sums are in a fixed order, so the bits do not depend on the number of
/// threads. Cost: O(#T).
Quality quality(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, Workers& workers);

/// Notes what evening added unseen to a map with the quality `before`. @param evenness from 0 to 1
void set_evened_from(Quality& quality, const Quality& before, double evenness);

/// The quality of the map scaled until its median density is this one; a map without area keeps its own.
Quality of_density(Quality quality, double density);

/// The quality of several maps together, each scaled like that. Triangles of one map follow those of the other.
/// @param qualities at least one. @param densities one for each
Quality joined(const std::vector<const Quality*>& qualities, const std::vector<double>& densities, Workers& workers);

}  // namespace holomorph::uv
