// What is known of harmonic forms that are never there all at once.
#pragma once

#include <span>
#include "mesh/intrinsic_triangulation.h"
#include "pipeline/harmonic_forms.h"
#include "uv/uv_map.h"

namespace holomorph::pipeline {

struct StreamedForms {
  Eigen::MatrixXd gram_matrix;  ///< <eta_i, h_j>, made symmetric
  double asymmetry = 0;         ///< largest |G - G^T| before that, over the largest entry: the error of the solver
  forms::Residuals residuals;
  double period_residual = 0;  ///< largest |int_{zeta_i} h_j - delta_ij|
  uv::FormSamples samples;     ///< on the artist's triangles
  SolverReport solver;
};

/// Solves for the harmonic forms block by block (plan.block at a time), measures each block and lets it go.
/// @param surface,loops,artist the artist's triangulation, the 2g loops and the classes on it
/// @param triangulation,weights,solver,intrinsic what is solved on, the solver of `plan`, and the classes there
/// The functions of `artist` and `intrinsic` are those of the block at hand, and none at the end.
/// Memory: that of `plan`. @throws SolverError, Cancelled
StreamedForms streamed_forms(const mesh::Surface& surface, const std::vector<std::vector<mesh::HalfedgeHandle>>& loops,
                             forms::ClosedForms& artist, const mesh::HalfEdges& triangulation,
                             std::span<const double> weights, solver::LaplaceSolver& solver,
                             forms::ClosedForms& intrinsic, const MemoryPlan& plan, Execution& execution);

/// Largest |int_{zeta_i} h_j - delta_ij| over all loops and these forms.
double period_residual(const mesh::EdgeEnds& ends, const forms::ClosedForms& forms,
                       const std::vector<std::vector<mesh::HalfedgeHandle>>& loops);

}  // namespace holomorph::pipeline
