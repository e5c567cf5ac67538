// The cotan Laplacian of a triangulation, assembled from the weights of its edges, and residuals of its systems summed
// flux by flux, for weights so large that rounding hides them in b - L f.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "base/execution.h"
#include "base/workers.h"
#include "forms/closed_forms.h"
#include "mesh/half_edges.h"
#include "solver/laplace_solver.h"

namespace holomorph::forms {

/// Assembles L = d^T k d, #V x #V, for edge weights k. Edges with the same ends add up. A loop adds nothing, as
/// functions have no difference along it.
/// @param weights #E, cotangent weights without unit
/// @throws Cancelled
/// Cost: linear, in parallel.
solver::Laplacian laplacian(const mesh::HalfEdges& half_edges, std::span<const double> weights, Execution& execution);

/// Adds the values of some forms along a half-edge. Several threads may call it at once.
using AddValues = std::function<void(mesh::HalfedgeHandle, Eigen::VectorXd& values)>;

/// The right-hand sides of systems L f_j = b_j, in terms that stay small where weights are large. The solution has no
/// net flux: at each vertex the outward flux, sum k (d f_j + eta_j) + k' eta'_j, plus the source is 0. Terms that are
/// left out are 0.
struct FluxTerms {
  AddValues eta = {};                          ///< eta_j, under the weights k
  AddValues outer_eta = {};                    ///< eta'_j, under the weights k'
  std::span<const double> outer_weights = {};  ///< k', #E
  Eigen::MatrixXd sources = {};                ///< #V x #forms
};

/// eta_j of the classes first, first + 1, ... @pre the classes outlive it
FluxTerms class_terms(const topology::IntegerForms& classes, int first, int count);

/// The same of real combinations of the classes: column j is sum_i combinations(i, j) eta_i.
FluxTerms class_terms(const topology::IntegerForms& classes, const Eigen::MatrixXd& combinations);

/// eta_j = d g_j. @param functions #V x #forms @pre the mesh outlives it
FluxTerms function_terms(const mesh::HalfEdges& half_edges, RowMajorMatrix functions);

struct HarmonicResiduals {
  Eigen::MatrixXd R;            ///< #V x #forms: the fluxes and sources, which are b - L f
  Eigen::RowVectorXd energies;  ///< #forms, of d f + eta + eta'; of d f + eta where k' is not k
};

/// Sums the fluxes of edges, k (f_i - f_j + eta), differences first and in twice the working precision. With k = 1e8
/// there are fluxes of 1e-8 left, of which b - L f has no digit. At fixed vertices R is the flux through the boundary.
/// Cost: about ten products with L, in parallel; the bits do not depend on the number of threads.
HarmonicResiduals harmonic_residuals(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                     const FluxTerms& terms, const RowMajorMatrix& functions, Workers& workers);

}  // namespace holomorph::forms
