// Roundings of forms that are their own mirror image.
#pragma once

#include <optional>

#include "tiling/poles/mirror.h"
#include "tiling/rounding/rounding.h"

namespace holomorph::tiling {

/// The problem restricted to integers with mirrored residues. Those of images are conjugate, up to the sign that
/// quarter turns of the texture bring. None where the lattice is not its own mirror image, or where a phase is given
/// that has no mirror image. A direction in space counts more than the mirror. Without a phase u -> -u.
/// @param options the same; changed to the quarter turn, and to more sizes
std::optional<RoundingProblem> mirrored(const RoundingProblem& problem, const std::vector<int>& poles,
                                        const Mirror& mirror, RoundingOptions& options);

}  // namespace holomorph::tiling
