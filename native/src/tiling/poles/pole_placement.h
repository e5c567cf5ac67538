// Where poles go so that the texture density becomes even.
#pragma once

#include "tiling/poles/meromorphic_form.h"
#include "tiling/poles/pole_candidates.h"

namespace holomorph::tiling {

/// Finds the most even form with `count` poles. Poles are added one by one where they help most. Then each in turn
/// moves to where the density becomes more even, or is removed and added anew, until nothing is gained. At last some
/// more are added, and those that matter least are removed. On a closed surface with handles a small term keeps them
/// where moving them can take up the rounding of the periods (inversion/abel_jacobi.h). The fixed ones are among them.
/// @throws TopologyError for a single pole on a closed surface, for none on a surface of genus 0, and where no vertex
/// is left whose star is apart from the others. SolverError; Cancelled
MeromorphicForm placed_poles(GreensFunctions& greens, const PlaceOptions& options, int count, Execution& execution);

/// Chooses the number of poles by the spread of the density. There are none if the spread is at most 3 without poles.
/// Else it is the first of 2, 4, 8, 12, 16 with which the spread is at most 5, or the last that lowered it by a tenth.
/// Where maps will be evened, the spread is the one expected of the evened map. Then there are no poles if it is at
/// most 2.85, else the first number with which it is at most 2.75.
MeromorphicForm placed_poles(GreensFunctions& greens, const PlaceOptions& options, Execution& execution);

/// Optimises coefficients and residues from those given; the poles stay the same.
MeromorphicForm optimised(GreensFunctions& greens, uv::Coefficients kind, MeromorphicForm start, Execution& execution);

}  // namespace holomorph::tiling
