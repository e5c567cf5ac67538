// One step of coarsening: which vertices are C-points, on the coarse level as well, and which are F-points.
#pragma once

#include "solver/multigrid/sparse_rows.h"

namespace holomorph::solver {

/// The operator of a level: (A x)_i = sum_j w_ij (x_i - x_j), n x n. It is kept and applied as differences, never with
/// a diagonal. In single precision, rows with a stored diagonal do not sum to 0, an error that drowns smooth functions.
struct Operator {
  SparseRows A;          ///< off-diagonal weights w_ij = -a_ij, of any signs
  Array<float> omega;    ///< n, the smoother's step: x += omega (r - A x); negative at a fixed vertex
  Array<float> largest;  ///< n: max_j w_ij, or 0 where none is positive
  Array<char> fixed;     ///< n: whether the vertex is fixed; empty where none is

  bool is_fixed(int i) const { return !fixed.empty() && fixed[i] != 0; }
};

struct Coarsening {
  Array<int> number;  ///< n: number of a C-point on the coarse level, in the same order; -1 for an F-point
  int count = 0;      ///< number of C-points
};

/// Classical coarsening (Ruge & Stuben 1987, doi:10.1137/1.9781611971057.ch4) by a maximal independent set. In the
/// order of the vertices each undecided one becomes a C-point. Its undecided neighbours j with w_ij >= 0.2 max_k w_jk
/// become F-points. A fixed vertex becomes an F-point only because of a fixed one, so that fixed vertices are coarsened
/// among themselves.
/// Cost: linear, one thread.
Coarsening coarsening(const Operator& fine);

}  // namespace holomorph::solver
