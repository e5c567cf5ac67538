// The linear systems of the harmonic forms on one triangulation: L f_j = -d* eta_j (paper § 6, Eq. 8).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/execution.h"
#include "forms/refined_solver.h"
#include "structure/memory_plan.h"
#include "structure/solver_report.h"

namespace holomorph::structure {

struct HarmonicFunctions {
  forms::RowMajorMatrix functions;  ///< #V x #forms
  SolverReport solver;
};

/// Set up before the classes are known. The triangulation and its weights outlive this.
class HarmonicSystems {
 public:
  /// @param fixed vertices at which Dirichlet functions are 0: those of the boundary
  /// @throws SolverError, Cancelled
  HarmonicSystems(const mesh::HalfEdges& half_edges, std::span<const double> weights, const std::vector<int>& fixed,
                  const solver::Choice& choice, Execution& execution);

  /// Is given the functions of the forms first, first + 1, ..., #V x #block.
  using TakeFunctions = std::function<void(int first, forms::RowMajorMatrix&& functions)>;

  /// Solves for `block` forms at a time, in order, and hands each block on.
  /// @param classes on the triangulation. @param natural how many of them are; the others are Dirichlet
  /// @throws SolverError, Cancelled
  void solve_in_blocks(const topology::IntegerForms& classes, int natural, int block, Execution& execution,
                       const TakeFunctions& take);
  /// The same, and all functions are kept.
  HarmonicFunctions solve(const topology::IntegerForms& classes, int natural, int block, Execution& execution);

  forms::RefinedSolver& solver() { return solver_; }
  SolverReport report() const;

 private:
  const mesh::HalfEdges& half_edges_;
  std::span<const double> weights_;
  forms::RefinedSolver solver_;
};

}  // namespace holomorph::structure
