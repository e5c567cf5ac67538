// Similar triangulations: the same triangles with the same angles, however numbered. They prove what periods cannot.
#pragma once

#include <optional>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::moduli {

/// Triangles whose map has a larger log of s1/s2 are not called similar: bounds of periods are as near.
inline constexpr double kSimilar = 0.01;

/// Walks over all triangles that the search may take, in parts of their number; beyond them it gives up silently.
inline constexpr int kMostWalks = 100;

/// A map of the triangles of one surface onto those of another, affine on each.
struct Similarity {
  /// Bound of log(s1/s2) of the map of any triangle, the errors of all lengths included: energies of corresponding
  /// classes differ by no more. Infinite where these errors leave the shape of a triangle open. Triangles whose sides
  /// are in one ratio, to the last bit, need no errors.
  double dilatation;
  /// Whether one factor takes all lengths to their images within their errors, so that the surfaces are the same as far
  /// as their numbers are exact. The error of a length that is given is mesh::length_error; of one between positions
  /// it is that and half a unit in the last place of each coordinate. So positions may be moved, turned and scaled.
  bool is_exact;
};

/// Finds a similarity of two connected surfaces that keeps the orientation, or with sign -1 reverses it: the first that
/// is exact, else the nearest. It starts at sides as long as the longest of `a`. Cost: linear for each walk, and less
/// where sides do not fit. @throws Cancelled
std::optional<Similarity> similarity(const mesh::Surface& a, const mesh::Surface& b, int sign, Execution& execution);

}  // namespace holomorph::moduli
