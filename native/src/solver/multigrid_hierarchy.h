// The levels of the multigrid preconditioner: an algebraic relative of the paper's progressive mesh (§ 3).
//
// A vertex that goes, drawn onto the staying neighbour of largest weight, is an edge collapse, and a step of coarsening
// a batch of them: a progressive mesh read from its base, batch by batch of vertex splits. Two things differ. The steps
// see the matrix alone, so that no coarse mesh has to be valid; and a coarse function is carried up by means of several
// values (P) and not of the parent's alone, with coarse operators P^T A P and not those of a coarse geometry: with the
// parent's value alone the solver takes ten times as many iterations, with coarse cotangents it may not converge.
#pragma once

#include <Eigen/Core>

#include "base/execution.h"
#include "solver/cycle_level.h"
#include "solver/laplace_solver.h"

namespace holomorph::solver {

struct Hierarchy {
  std::vector<CycleLevel> levels;    ///< finest first
  Array<float> rests;                ///< weight_rests() of the finest level
  Eigen::MatrixXf coarsest_inverse;  ///< pseudo-inverse of the coarsest A, computed in double precision
  Eigen::MatrixXf held_inverse;      ///< inverse of the part without the held vertices, and 0 at these; or empty

  /// Sum of all entries of the matrices over those of the finest.
  double operator_complexity() const;
};

/// Coarsens until 250 vertices are left. Operators are kept and applied as differences, never with a diagonal: in
/// single precision the rows of a stored diagonal form do not sum to 0, and smooth functions drown in that.
/// L is given up as soon as its weights are in the hierarchy.
/// @throws SolverError if the graph cannot be coarsened further or the matrix is not semi-definite; there is a finest
///   level then, of which laplacian_of() makes L again; Cancelled
/// Cost: linear; about 0.2 KB and 0.5 us per vertex.
///
/// The held vertices of a level are among those of the level above, and their values are means of theirs alone. So one
/// hierarchy serves both conditions: functions that are 0 at the held vertices of a level are so on all.
void make_hierarchy(Laplacian&& L, const std::vector<int>& held, Workers& workers, Execution& execution,
                    Hierarchy& hierarchy);

}  // namespace holomorph::solver
