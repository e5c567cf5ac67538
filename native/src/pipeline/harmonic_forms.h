// Which solver is used, and what it reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "forms/harmonic_basis.h"

namespace holomorph::pipeline {

struct Options {
  std::string solver = "auto";       ///< "auto", "direct", "multigrid" or "paper"
  int threads = 0;                   ///< 0: as many as the machine has cores; the result does not depend on it
  std::string boundary = "natural";  ///< "natural", or "double_cover": over the double of a surface with boundary
};

/// Conjugate gradients on one level of a progressive mesh.
struct LevelReport {
  std::int64_t faces = 0;
  int iterations = 0;
  double seconds = 0;  ///< with the making of the linear system
};

struct SolverReport {
  std::string name, reason;
  int iterations = 0;   ///< of multigrid, or the paper's on the surface; steps of refinement of the direct solver
  double residual = 0;  ///< largest relative residual of the linear systems
  std::vector<LevelReport> levels = {};  ///< of the paper's solver, the base mesh first
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
