// Chooses the form of a tiling among roundings: moves the poles for each one, and compares the results.
#pragma once

#include <vector>

#include "tiling/placement.h"
#include "tiling/rounding/rounding.h"

namespace holomorph::tiling {

/// A rounding, and the poles that go with it.
struct Candidate {
  Rounding rounding;
  LiftedPoles poles;
  VectorXcd residues;  ///< for all poles
  VectorXcd X;         ///< periods besides the poles; with boundary c

  std::vector<Index> used() const;  ///< the poles of the tiling: those whose rounded residue is not 0
};

/// Moves the poles for each rounding, and returns the candidate of lowest rank.
/// @param lifted the poles of the problem, before they move
/// @pre the list is not empty. @throws SolverError, Cancelled
Candidate best_candidate(const Placement& placement, const RoundingProblem& problem, const std::vector<Rounding>& list,
                         const LiftedPoles& lifted, Execution& execution);

struct PoleMove {
  int pole = 0;  ///< among those that are used
  int vertex = 0;

  bool operator==(const PoleMove&) const = default;
};

/// Moves poles of a candidate. Residues and periods stay the same; each pole takes the shortest path. On a closed
/// surface with handles the other poles, where they were not chosen, move until the form is holomorphic again.
/// @throws TopologyError for poles that do not fit; SolverError; Cancelled
Candidate with_poles_moved(const Placement& placement, const RoundingProblem& problem,
                           const std::vector<PoleMove>& moves, Candidate candidate, Execution& execution);

}  // namespace holomorph::tiling
