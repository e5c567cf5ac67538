// Where poles go so that the texture density becomes even.
#pragma once

#include <vector>

#include "tiling/landscape.h"
#include "tiling/pole_candidates.h"
#include "tiling/poles.h"

namespace holomorph::tiling {

/// Poles are added one by one where they help most, until there are `count`; then each in turn moves to where the
/// density becomes more even, or is taken away and added anew, until nothing is gained; then some more are added, and
/// those that matter least taken away again. On a closed surface with
/// handles a small term keeps them where moving them can take up the rounding of the periods (leverage.h). The fixed
/// ones are among them.
/// @throws TopologyError for a single pole on a closed surface, a surface of genus 0 without any, or where no vertex is
/// left whose star is apart from those of the others; SolverError; Cancelled
Poles placed_poles(Landscape& landscape, const PlacementRules& rules, int count, Execution& execution);

/// As many as the density asks for: none where its spread is at most 3 without; else the first of 2, 4, 8, 12, 16 with
/// which it is at most 5, or the last with which it fell.
Poles placed_poles(Landscape& landscape, const PlacementRules& rules, Execution& execution);

/// With the best coefficients and residues near those given.
Poles optimised(Landscape& landscape, const PlacementRules& rules, Poles start, Execution& execution);

}  // namespace holomorph::tiling
