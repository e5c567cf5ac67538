// Harmonic functions with prescribed values.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/execution.h"
#include "mesh/half_edges.h"
#include "structure/options.h"
#include "structure/solver_report.h"

namespace holomorph::plane {

struct DirichletSolution {
  Eigen::MatrixXd functions;  ///< #V x m
  Eigen::VectorXd energies;   ///< m, f . L f
  double harmonicity = 0;     ///< largest |L f| at a free vertex over the largest sum of its terms
  structure::SolverReport solver;
};

/// sum_e k_e (f_head - f_tail)^2 of each column, with any numbers k_e for weights: m.
Eigen::VectorXd energies(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                         const Eigen::MatrixXd& functions);

/// L f = 0 at the free vertices; natural at those of the boundary.
/// Refined where weights ask for it (forms/refined_solver.h).
/// @param values #V x m, 0 at the free vertices
/// @throws SolverError, Cancelled
DirichletSolution solve_dirichlet(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                                  const std::vector<int>& fixed, const Eigen::MatrixXd& values,
                                  const structure::Options& options, Execution& execution);

}  // namespace holomorph::plane
