// The Laplacian of a surface with vertices held at 0, and a solver made for it: what the forms are found with, by
// itself.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "pipeline/harmonic_forms.h"

namespace holomorph::pipeline {

struct LaplaceProblem {
  std::vector<std::array<int, 2>> ends;  ///< of the edges of the intrinsic Delaunay triangulation
  Array<double> weights;                 ///< of these edges: (L x)_i = sum_j w_ij (x_i - x_j)
  std::unique_ptr<solver::LaplaceSolver> solver;
};

/// @param held vertices, at 0 for right-hand sides with the condition dirichlet
/// @throws SolverError, Cancelled
LaplaceProblem laplace_problem(const mesh::Surface& surface, const std::vector<int>& held, const Options& options,
                               Execution& execution);

}  // namespace holomorph::pipeline
