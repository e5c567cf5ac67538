// From roundings to the form of a tiling: the poles move for each, and what comes out is compared.
#pragma once

#include <vector>

#include "tiling/placement.h"
#include "tiling/rounding/rounding.h"

namespace holomorph::tiling {

/// A rounding with its poles where they are.
struct Candidate {
  Rounding rounding;
  LiftedPoles poles;
  VectorXcd residues;  ///< for all poles
  VectorXcd X;         ///< periods besides the poles; with boundary c

  std::vector<Index> used() const;  ///< the poles of the tiling: a rounding may need fewer than there are
};

/// The best of what comes out of the roundings: of the lowest rank, with the poles where they then are.
/// @param lifted the poles of the problem where they are
/// @pre the list is not empty. @throws SolverError, Cancelled
Candidate best_candidate(const Placement& placement, const RoundingProblem& problem, const std::vector<Rounding>& list,
                         const LiftedPoles& lifted, Execution& execution);

struct PoleMove {
  int pole = 0;  ///< among those that are used
  int vertex = 0;
};

/// The candidate with its poles moved. Residues and periods stay the same; each pole takes the shortest path. On a
/// closed surface with handles the other poles, where they were not chosen, move until the form is holomorphic again.
/// @throws TopologyError for poles that do not fit; SolverError; Cancelled
Candidate with_poles_moved(const Placement& placement, const RoundingProblem& problem,
                           const std::vector<PoleMove>& moves, Candidate candidate, Execution& execution);

}  // namespace holomorph::tiling
