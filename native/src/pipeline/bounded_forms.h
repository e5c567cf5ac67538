// The two families of harmonic forms on a surface with boundary.
#pragma once

#include <span>
#include "mesh/boundary_loops.h"
#include "pipeline/harmonic_forms.h"

namespace holomorph::pipeline {

/// n = 2g + b - 1 forms each. natural: one for each class of H^1(M), d* h = 0 at every vertex. dirichlet: zero along
/// the boundary, one for each class of H^1(M, dM), d* h = 0 at the interior vertices: first those of the 2g handle
/// classes, f = 0 on the boundary; then the harmonic measures of the loops 1 .. b-1, eta = 0 and f = 1 on their loop, 0
/// on the others. These boundary values are exact.
struct BoundedForms {
  forms::ClosedForms natural, dirichlet;
  SolverReport solver;
};

/// Adds 1 on each boundary loop k >= 1 to the function of its form, column handles + k - 1.
void add_indicators(const mesh::BoundaryLoops& boundary, int handles, forms::RowMajorMatrix& functions);

/// #V x 2n: the natural functions, then the Dirichlet ones.
forms::RowMajorMatrix side_by_side(const BoundedForms& forms);

/// @param classes n natural classes: those of the 2g handles, zero along the boundary, and then those of the loops
/// @param options boundary "double_cover" takes the way over the double instead
/// @throws SolverError, Cancelled
BoundedForms bounded_forms(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                           solver::Laplacian&& laplacian, const topology::IntegerForms& classes,
                           const mesh::BoundaryLoops& boundary, const Options& options, Execution& execution);

}  // namespace holomorph::pipeline
