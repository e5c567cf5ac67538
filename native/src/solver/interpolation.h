// One step of coarsening: which vertices stay, and how a function on them is carried to the others.
#pragma once

#include "base/execution.h"
#include "solver/row_sums.h"
#include "solver/sparse_rows.h"

namespace holomorph::solver {

/// Which vertices stay.
struct Coarsening {
  Array<int> number;  ///< #V: of the vertex on the coarse level, in the same order, or -1 for a vertex that goes
  int count = 0;      ///< of vertices that stay
};

/// Classical coarsening (Ruge & Stuben 1987, doi:10.1137/1.9781611971057.ch4) by a maximal independent set: in the
/// order of the vertices each undecided one stays, and its undecided neighbours j with w_ij >= 0.2 max_k w_jk go.
/// A held vertex goes only because of a held one, so that held vertices are coarsened among themselves.
/// @param A off-diagonal weights w_ij = -a_ij, #V rows
/// @param largest #V: max_k w_ik, or 0 where none is positive
/// @param held one flag per vertex, or empty for none
/// Cost: linear, by one thread.
Coarsening coarsening(const SparseRows& A, const Array<float>& largest, const Array<char>& held);

/// P, #V x #coarse: the value at a vertex i that goes is a mean over its neighbours, in each of which that goes as well
/// a mean over that one's staying neighbours and i itself, for whose value the sum is solved (extended+i interpolation,
/// De Sterck, Falgout, Nolting & Yang 2008, doi:10.1002/nla.559; without i a sixth more iterations). Positive weights
/// alone, and of the result the `most` largest entries.
///
/// Every row sums to 1 exactly: all weights but the largest are multiples of 2^-20. Then constants are carried exactly,
/// and the rounding of a large weight of a sliver does not become a coupling on the coarse level.
/// The row of a held vertex has entries at held ones alone: a coarse function that is 0 at the held vertices is so on
/// the fine level as well, and P^T A P without their rows and columns is the coarse operator of A without them.
/// @param A,largest,held of coarsening()
/// @param coarse number of Coarsening
/// @param most 2 or 3
/// @param scratch one per thread, for rows as long as the coarse level
EqualRows interpolation(const SparseRows& A, const Array<float>& largest, const Array<char>& held,
                        const Array<int>& coarse, int most, std::vector<RowSums<float>>& scratch, Workers& workers,
                        Execution& execution);

}  // namespace holomorph::solver
