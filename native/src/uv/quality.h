// Distortion of UV maps.
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <vector>

#include "base/execution.h"
#include "base/page_allocator.h"
#include "base/workers.h"
#include "uv/direction.h"
#include "uv/uv_map.h"

namespace holomorph::uv {

/// Shares at which the range of densities is measured.
inline constexpr double kLow = 0.05, kHigh = 0.95;

/// Quantiles of weighted values: weights of values >= 0 by the leading bits of the values, of which there are 16
/// classes in each octave: they are in the order of the values. Only the items of the class with a quantile are visited
/// again. Fewer values than classes are all in one, which is visited sooner than all classes. Values and weights
/// outlive this.
class Distribution {
 public:
  Distribution(const Array<double>& values, const Array<double>& weights, Workers& workers);

  /// The value below which this fraction of the total weight lies; 0 where there is none. Cost: linear
  double quantile(double fraction) const;

 private:
  struct Weighted {
    double value, weight;
  };
  static constexpr int kMost = 1 << 15;

  std::size_t begin(int part) const { return values_.size() * part / parts_; }
  std::size_t class_of(double value) const;
  std::vector<Weighted> items_of(std::size_t k) const;
  static double quantile(std::vector<Weighted>& items, double wanted);

  const Array<double>& values_;
  const Array<double>& weights_;
  Workers& workers_;
  const int parts_;  // number of parts processed in parallel
  std::vector<double> classes_;
  double total_ = 0;
};

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

/// The ends of an edge of a curve.
using Ends = std::array<std::complex<double>, 2>;

/// Computes the part of the region around which closed curves wind that they wind around more than once: 0 where the
/// map that they bound lies beside itself nowhere, or is not finite.
///
/// The winding number is exact along each of up to 4096 horizontal lines at equal distances, the area the sum of the
/// lengths: an overlap lower than their distance may lie between two of them. A curve of many edges across all lines,
/// as around a star, has fewer lines.
/// @param curve directed edges, which make closed curves. @throws Cancelled
/// Cost: O(m log m) for m crossings, at most half a million or 64 for each edge.
double overlapping_part(const std::vector<Ends>& curve, Execution& execution);

}  // namespace holomorph::uv
