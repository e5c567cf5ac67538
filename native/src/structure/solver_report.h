// How the linear systems were solved.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "forms/refined_solver.h"

namespace holomorph::structure {

// What a caller chooses about the solution.

/// How the forms of a surface with boundary are found: on the surface itself, or over its double (paper § 8).
enum class Boundary { natural, double_cover };

struct Options {
  std::string solver = "auto";    ///< "auto", "direct" or "multigrid"
  std::int64_t memory_limit = 0;  ///< bytes, 0: none; see plan_memory
  Boundary boundary = Boundary::natural;
};

/// Conjugate gradients on one level of a progressive mesh.
struct LevelReport {
  std::int64_t faces = 0;
  int iterations = 0;
  double seconds = 0;  ///< with the assembly of the linear system
};

struct SolverReport {
  std::string name, reason;
  int iterations = 0;  ///< iterations of multigrid, or of the paper's solver on the surface; steps of refinement of the
                       ///< direct solver
  double residual = 0;  ///< largest relative residual of the linear systems; of refined forms the error in energy
  std::vector<LevelReport> levels = {};  ///< levels of the paper's solver, the base mesh first
};

/// What a solver reports after its last solve.
inline SolverReport solver_report(const forms::RefinedSolver& refined) {
  const solver::LaplaceSolver& solver = refined.solver();
  const std::string remark = solver.remark(), reason = refined.choice().reason;
  return {solver.name(), reason + (remark.empty() ? "" : "; " + remark), solver.iterations(), refined.residual(), {}};
}

}  // namespace holomorph::structure
