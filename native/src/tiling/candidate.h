// Which of the roundings becomes the tiling: the poles move for each, and what comes out is compared.
#pragma once

#include <vector>

#include "tiling/landscape.h"
#include "tiling/pole_moves.h"
#include "tiling/rounding.h"

namespace holomorph::tiling {

/// A rounding with its poles where they are.
struct Candidate {
  Rounding rounding;
  PlacedPoles poles;
  Eigen::VectorXcd residues;  ///< of all poles
  Eigen::VectorXcd X;         ///< periods besides the poles; with boundary c

  std::vector<Eigen::Index> used() const;  ///< the poles of the tiling: a rounding may need fewer than there are
};

struct Mobility {
  const PoleMoves* pole_moves = nullptr;  ///< on a closed surface with handles
  bool movable = true;                    ///< or do the poles stay where they are
  const std::vector<char>& allowed;       ///< #V: where they may go; empty: anywhere
};

/// The best of what comes out of the roundings: of the lowest rank, with the poles where they then are.
/// @param placed the poles of the problem where they are. @pre the list is not empty
Candidate best_candidate(const RoundingProblem& problem, const std::vector<Rounding>& list, const PlacedPoles& placed,
                         const Mobility& mobility, double tiles, Landscape& landscape, Execution& execution);

}  // namespace holomorph::tiling
