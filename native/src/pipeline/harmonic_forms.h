// Which solver is used, what it reports, and the harmonic forms that it finds, block by block.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/execution.h"
#include "forms/harmonic_basis.h"
#include "pipeline/memory_plan.h"

namespace holomorph::pipeline {

struct Options {
  std::string solver = "auto";       ///< "auto", "direct", "multigrid" or "paper"
  int threads = 0;                   ///< 0: as many as the machine has cores; the result does not depend on it
  std::int64_t memory_limit = 0;     ///< bytes, 0: none; see plan_memory
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

/// Is given the functions of the forms first, first + 1, ..., #V x #block.
using TakeFunctions = std::function<void(int first, forms::RowMajorMatrix&& functions)>;

/// Solves for plan.block forms at a time, in order, and hands each block on.
/// @param solver that of the plan. @throws SolverError, Cancelled
SolverReport solve_in_blocks(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                             solver::LaplaceSolver& solver, const topology::IntegerForms& classes,
                             const MemoryPlan& plan, Execution& execution, const TakeFunctions& take);

struct HarmonicForms {
  forms::ClosedForms forms;
  SolverReport solver;
};

/// The harmonic form of each class, all of them kept.
/// @throws SolverError, Cancelled
HarmonicForms harmonic_forms(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                             solver::LaplaceSolver& solver, const topology::IntegerForms& classes,
                             const MemoryPlan& plan, Execution& execution);

/// The same with the solver that `options` asks for; its memory is free again at the end.
HarmonicForms harmonic_forms(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                             solver::Laplacian&& laplacian, const topology::IntegerForms& classes,
                             const Options& options, Execution& execution);

}  // namespace holomorph::pipeline
