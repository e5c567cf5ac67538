// Roundings of forms that are their own mirror image.
#pragma once

#include <optional>

#include "tiling/poles/mirror.h"
#include "tiling/rounding/rounding.h"

namespace holomorph::tiling {

/// Restricts the problem to integers with mirrored residues: those of images are conjugate, up to the sign that a
/// quarter turn of the texture brings. None where the lattice is not its own mirror image, or where the given phase is
/// no multiple of a quarter turn: a direction in space counts more than the mirror. Without a phase the symmetry is u
/// -> -u.
/// @param options the same; changed to the quarter turn, and to more sizes
std::optional<RoundingProblem> mirrored(const RoundingProblem& problem, const std::vector<int>& poles,
                                        const Mirror& mirror, RoundingOptions& options);

}  // namespace holomorph::tiling
