// From roundings to a tiling: the poles move for each, and what comes out is compared. And a tiling with some of its
// poles elsewhere: the residues stay, and so do the periods, but that a pole's way around a handle is taken for the
// shortest.
#pragma once

#include <vector>

#include "tiling/inversion/jacobi_inversion.h"
#include "tiling/poles/meromorphic_form.h"
#include "tiling/rounding/rounding.h"

namespace holomorph::tiling {

/// A rounding with its poles where they are.
struct Candidate {
  Rounding rounding;
  LiftedPoles poles;
  VectorXcd residues;  ///< of all poles
  VectorXcd X;         ///< periods besides the poles; with boundary c

  std::vector<Index> used() const;  ///< the poles of the tiling: a rounding may need fewer than there are
};

/// How the poles may move.
struct Mobility {
  const JacobiInversion* inversion = nullptr;  ///< on a closed surface with handles
  bool movable = true;                         ///< or do the poles stay where they are
  const std::vector<char>& allowed;            ///< #V: where they may go; empty: anywhere
};

/// The best of what comes out of the roundings: of the lowest rank, with the poles where they then are.
/// @param placed the poles of the problem where they are. @param greens with those of the poles
/// @pre the list is not empty. @throws SolverError, Cancelled
Candidate best_candidate(const RoundingProblem& problem, const std::vector<Rounding>& list, const LiftedPoles& placed,
                         const Mobility& mobility, double tiles, GreensFunctions greens, Execution& execution);

/// Splits the periods, `besides` and those of the residues, into the holomorphic and the antiholomorphic part.
void set_periods(const VectorXcd& besides, const Jacobian& jacobian, Candidate& candidate);

/// Measures the rounding with the poles where they are. @pre their Green's functions were solved for
void measure(const RoundingProblem& problem, const GreensFunctions& greens, Candidate& candidate);

struct PoleMove {
  int pole = 0;  ///< among those that are used
  int vertex = 0;
};

/// Places poles at their new vertices. @param labels what a vertex is called in messages; empty: its index
/// @return for each pole whether it was moved. @throws TopologyError
std::vector<char> place_at(const std::vector<PoleMove>& moves, const PoleBasis& basis, const std::vector<int>& labels,
                           Candidate& candidate);

/// What follows on a closed surface with handles: the poles that are not held move until the form is holomorphic again.
/// @param metric g x g, as JacobiInversion::moved has it. @throws SolverError
void follow_by_inversion(const JacobiInversion& inversion, const MatrixXcd& metric, const MoveOptions& options,
                         const std::vector<char>& moved, Candidate& candidate);

/// What follows with boundary.
/// @param parts #natural x #used poles: their harmonic parts where they now are
void follow_with_boundary(const PoleBasis& basis, const RoundingProblem& problem, const MatrixXd& parts,
                          Candidate& candidate);

}  // namespace holomorph::tiling
