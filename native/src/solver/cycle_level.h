// A level of the multigrid hierarchy as the cycle goes through it.
#pragma once

#include "base/workers.h"
#include "solver/grouped_rows.h"

namespace holomorph::solver {

struct CycleLevel {
  int rows = 0;
  int chunks = 0;      ///< of the rows, and of those of the next level that follow from them
  GroupedRows A;       ///< off-diagonal weights w_ij = -a_ij: (A x)_i = sum_j w_ij (x_i - x_j)
  EqualRows P;         ///< interpolation from the next level; rows sum to 1; none on the coarsest level
  GroupedRows R;       ///< its transpose
  Array<float> omega;  ///< #V, the smoother's step: x += omega (r - A x); negative at a held vertex
  Wavefront down;      ///< any loop over the rows, one that applies A, one that applies R
  Wavefront up;        ///< any loop over the rows, and two that apply A, the last after all that read its chunk

  int begin(int chunk) const { return Chunks{rows, kWaveRows}.begin(chunk); }
  int end(int chunk) const { return Chunks{rows, kWaveRows}.end(chunk); }
};

/// @param P, R, needs_of_A empty on the coarsest level
/// @param needs_of_A for every chunk needs_of(A)
/// Cost: linear, parallel.
CycleLevel cycle_level(GroupedRows&& A, EqualRows&& P, GroupedRows&& R, Array<float>&& omega, const Needs& needs_of_A,
                       Workers& workers);

}  // namespace holomorph::solver
