// How much of the plane a map covers twice.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "base/execution.h"

namespace holomorph::uv {

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
