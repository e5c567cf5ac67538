// Which solver is used, and what it reports.
#pragma once

#include <string>

#include "base/progress.h"
#include "forms/harmonic_basis.h"

namespace holomorph::pipeline {

struct Options {
  std::string solver = "auto";  ///< "auto", "direct" or "multigrid"
  int threads = 0;              ///< 0: as many as the machine has cores; the result does not depend on it
};

struct SolverReport {
  std::string name, reason;
  int iterations = 0;   ///< of multigrid; steps of iterative refinement of the direct solver
  double residual = 0;  ///< largest relative residual of the linear systems
};

/// What a solver reports after its last solve.
SolverReport solver_report(const solver::LaplaceSolver& solver, const solver::Choice& choice);

struct HarmonicForms {
  forms::ClosedForms forms;
  SolverReport solver;
};

/// The harmonic form of each class, with the solver that `options` asks for; its memory is free again at the end.
/// @throws SolverError, Cancelled
HarmonicForms harmonic_forms(const mesh::HalfEdges& half_edges, const std::vector<double>& weights,
                             solver::Laplacian&& laplacian, const topology::IntegerForms& classes,
                             const Options& options, Progress& progress);

}  // namespace holomorph::pipeline
