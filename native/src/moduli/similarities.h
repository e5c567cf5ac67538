// Similar triangulations: the same triangles with the same angles, however numbered. They prove what periods cannot.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"

namespace holomorph::moduli {

/// A map of the triangles of `a` onto those of `b` that multiplies all lengths by one factor, to rounding.
struct Similarity {
  int sign = 1;            ///< -1: it reverses the orientation
  std::vector<int> sides;  ///< #T: side 3 t' + i of `b` that is the image of side 0 of each triangle of `a`
  /// log of the largest s1/s2 of a triangle's map: energies of corresponding classes differ by less than that.
  double dilatation = 0;
};

/// Triangles whose map has a larger log of s1/s2 are not called similar.
inline constexpr double kSimilar = 1e-8;

/// What is searched for.
struct SimilarityOptions {
  int sign = 1;
  std::size_t most = 1;          ///< ends with so many
  std::int64_t triangles = 100;  ///< of `a`, times their number: limit of the search, which gives up silently
};

/// Finds the similarities of two connected surfaces, from sides as long as the longest of `a` by walking over all
/// triangles. Cost: linear for each one, and less where sides do not fit. @throws Cancelled
std::vector<Similarity> similarities(const mesh::Surface& a, const mesh::Surface& b, const SimilarityOptions& options,
                                     Execution& execution);

}  // namespace holomorph::moduli
