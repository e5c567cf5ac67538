// The Laplacian of a surface with vertices fixed at 0, and a solver made for it, for callers with right-hand sides of
// their own.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/execution.h"
#include "mesh/surface.h"
#include "solver/laplace_solver.h"
#include "structure/options.h"

namespace holomorph::structure {

struct LaplaceProblem {
  std::vector<std::array<int, 2>> ends;  ///< ends of the edges of the intrinsic Delaunay triangulation
  Array<double> weights;                 ///< weights of these edges: (L x)_i = sum_j w_ij (x_i - x_j)
  std::unique_ptr<solver::LaplaceSolver> solver;
  int threads = 0;  ///< threads of the execution that made it
};

/// @param fixed vertices, at 0 for right-hand sides with the condition dirichlet
/// @throws SolverError, Cancelled
LaplaceProblem laplace_problem(const mesh::Surface& surface, const std::vector<int>& fixed, const Options& options,
                               Execution& execution);

}  // namespace holomorph::structure
