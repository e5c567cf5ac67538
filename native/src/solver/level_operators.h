// The operators of the levels: the given matrix in single precision, and P^T A P.
#pragma once

#include "base/execution.h"
#include "solver/interpolation.h"
#include "solver/multigrid_hierarchy.h"

namespace holomorph::solver {

/// A level while the next one is made from it.
struct Level {
  SparseRows A;
  Needs needs_of_A;  ///< this and what follows: none on the coarsest level
  EqualRows P;
  SparseRows R;      ///< its transpose, in chunks as many as those of A
  Array<char> held;  ///< one flag per vertex, or empty for none
};

/// A level's operator and what its rows say.
struct Operator {
  SparseRows A;          ///< off-diagonal weights w_ij = -a_ij
  Array<float> omega;    ///< of CycleLevel
  Array<float> largest;  ///< #V: max_j w_ij, or 0 where none is positive
};

/// The weights of L without those that are only rounding. @param held one flag per vertex, or empty for none
Operator finest_operator(const Laplacian& L, const Array<char>& held, Workers& workers, Execution& execution);

/// P^T A P, summed in double precision; its diagonal follows from the other entries, as rows sum to 0.
/// @param fine with A, P and R
/// @param held of the coarse level
/// @param scratch one per thread, for rows as long as the coarse level
Operator coarse_operator(const Level& fine, const Array<char>& held, std::vector<RowSums<double>>& scratch,
                         Workers& workers, Execution& execution);

}  // namespace holomorph::solver
