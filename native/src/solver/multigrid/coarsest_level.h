// The exact solution on the coarsest level: dense inverses.
#pragma once

#include <Eigen/Core>

#include "solver/multigrid/coarsening.h"

namespace holomorph::solver {

struct CoarsestInverse {
  Eigen::MatrixXf natural;    ///< pseudo-inverse of A
  Eigen::MatrixXf dirichlet;  ///< inverse of the part of A without the fixed vertices, 0 at these; empty without any
};

/// Both symmetric, computed in double precision. Cost: cubic in the size of A, which is a few hundred.
/// @throws SolverError if A is not positive semi-definite
CoarsestInverse coarsest_inverse(const Operator& coarsest);

}  // namespace holomorph::solver
