// Iterative refinement of harmonic forms where weights hide the residuals of their linear systems.
#pragma once

#include <span>
#include <vector>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/half_edges.h"
#include "solver/laplace_solver.h"

namespace holomorph::structure {

/// Errors of forms in the energy norm, relative to the form's own: what refinement goes on to while it helps, and what
/// is promised. Energies, and with them Gram matrices and bounds, are off by the square.
inline constexpr double kEnergyGoal = 1e-10, kEnergyError = 1e-6;

/// Forms eta + d f of the classes first, first + 1, ..., one for each condition.
struct FormBlock {
  const topology::IntegerForms& classes;
  int first;
  std::vector<solver::Condition> conditions;
};

/// A triangulation with its weights, and the vertices at which Dirichlet functions are prescribed.
struct WeightedEdges {
  const mesh::HalfEdges& half_edges;
  std::span<const double> weights;
  const std::vector<int>& fixed;
};

/// Whether weights are so large that a residual of 1e-10 of the right-hand side, or what rounding allows, does not mean
/// small errors of the forms: then they are to be refined.
bool is_stiff(std::span<const double> weights, Workers& workers);

/// Adds L^-1 r to the functions, r of forms::harmonic_residuals, until |h - h_exact|^2 = r . L^-1 r is small enough, or
/// as small as the rounding of the functions allows.
/// @return the largest error, relative. @throws SolverError where it is not kEnergyError; Cancelled
double refine(const WeightedEdges& edges, const FormBlock& block, forms::RowMajorMatrix& functions,
              solver::LaplaceSolver& solver, Execution& execution);

}  // namespace holomorph::structure
